#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "polar/pipeline/outputs.hpp"
#include "polar/report/batch_page.hpp"
#include "polar/report/page.hpp"
#include "record_path.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/isolation.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string result, output;
};

std::string batch(const Arguments& a) {
  const std::string page = a.output.empty() ? a.result + "/" + kReportFile : a.output;
  write_batch_report(a.result, page, report_name(a.result));
  return page;
}

std::string single(const Arguments& a) {
  const std::string record = record_path(a.result);
  const std::string folder = std::filesystem::path(record).parent_path().string();
  const std::string page = a.output.empty() ? (folder.empty() ? "." : folder) + "/" + kReportFile : a.output;
  const RunRecord read = smlm::read_isolated(record, [&] { return read_run_record(record); });
  smlm::write_file_atomically(page, report_page(read, report_name(folder.empty() ? "." : folder)));
  return page;
}

int run(const Arguments& a) {
  std::error_code unseen;  // whoever opens it says why
  const bool is_batch = std::filesystem::is_regular_file(a.result + "/batch.json", unseen);
  std::printf("%s\n", (is_batch ? batch(a) : single(a)).c_str());
  return 0;
}
}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("report", "Write the page of a result or of a batch anew");
  sub->add_option("result", a->result, "result directory, results.h5, or the directory of a batch")
      ->required();
  sub->add_option("--output", a->output, "file; default: report.html beside what it is made from");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
