#include "polar/pipeline/batch.hpp"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>

#include "batch_files.hpp"
#include "batch_tables.hpp"
#include "child_process.hpp"
#include "config/nearest.hpp"
#include "dataset_end.hpp"
#include "json_text.hpp"
#include "polar/core/parallel.hpp"
#include "polar/report/batch_page.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using pipeline::ChildProcess;
using pipeline::DatasetRow;

constexpr int kRefresh_ms = 500;
constexpr int kStopped = 128;  // of a child that was asked to stop
constexpr const char* kGoesOn = "out of its time: the same command goes on from there";

struct Running {
  std::size_t dataset;
  std::unique_ptr<ChildProcess> process;
};

class Batch {
 public:
  Batch(const BatchConfig& config, const BatchFlags& flags, Progress& progress, const Engine& engine)
      : config_(config), flags_(flags), progress_(progress), engine_(engine) {
    require_known_names(config, flags);
    for (const DatasetConfig& d : config.datasets)
      rows_.push_back({d.name, d.condition, "waiting", {}, 0, {}});
  }

  BatchOutcome run() {
    make_directory();
    find_what_is_there();
    write_tables();
    total_ = waiting_.size();
    while (!running_.empty() || (!waiting_.empty() && !progress_.cancelled())) {
      while (!waiting_.empty() && running_.size() < static_cast<std::size_t>(flags_.jobs) &&
             !progress_.cancelled())
        start();
      progress_.step("data sets", static_cast<int>(ended_), static_cast<int>(total_));
      listen();
      if (progress_.cancelled()) stop();
    }
    write_page();
    return outcome();
  }

 private:
  bool wanted(const std::string& name) const { return is_wanted(flags_, name); }

  std::string file(const std::string& name) const { return config_.directory + "/" + name; }

  void make_directory() const {
    std::error_code ec, unseen;
    std::filesystem::create_directories(config_.directory, ec);
    if (!std::filesystem::is_directory(config_.directory, unseen))
      throw smlm::Error(smlm::Fault::io, config_.directory,
                        ec ? "cannot be created: " + ec.message() : "is not a directory",
                        "choose another output.directory");
  }

  void load_summary(std::size_t i) {
    std::ifstream in(config_.datasets[i].run.output.directory + "/summary.json");
    rows_[i].summary = nlohmann::json::parse(in, nullptr, false);
  }

  void find_what_is_there() {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (flags_.part != BatchPart::data_sets || wanted(rows_[i].name)) look_at(i);
  }

  void look_at(std::size_t i) {
    const DatasetConfig& d = config_.datasets[i];
    if (!d.fault.empty()) return fail(i, d.fault_code, d.fault);
    const bool run_by_another = flags_.part == BatchPart::tables && wanted(d.name);
    try {
      if (is_complete(d.run)) {
        rows_[i].state = run_by_another ? "done" : "kept";
        load_summary(i);
        return;
      }
    } catch (const smlm::Error& e) {
      return fail(i, e.exit_code(), e.what());
    }
    if (run_by_another)
      take_over(i);
    else if (wanted(d.name))
      waiting_.push_back(i);
  }

  // From the process that ran it.
  void take_over(std::size_t i) {
    const auto end = pipeline::read_dataset_end(file(pipeline::kBatchTasks), rows_[i].name);
    if (!end) return fail(i, 1, "it left no word of its end: it was killed, or never begun");
    if (end->stopped)
      rows_[i].state = "stopped";
    else
      fail(i, end->exit_code, end->reason);
  }

  void leave_word(std::size_t i) const {
    const DatasetRow& row = rows_[i];
    if (flags_.part == BatchPart::data_sets)
      pipeline::write_dataset_end(file(pipeline::kBatchTasks), row.name,
                                  {row.state == "stopped", row.exit_code, row.reason});
  }

  void fail(std::size_t i, int code, const std::string& reason) {
    rows_[i].state = "failed";
    rows_[i].exit_code = code;
    rows_[i].reason = reason;
    leave_word(i);
    if (wanted(rows_[i].name)) progress_.note(rows_[i].name + ": failed: " + reason);
  }

  void start() {
    const std::size_t i = waiting_.front();
    waiting_.erase(waiting_.begin());
    const RunConfig& run_config = config_.datasets[i].run;
    const auto work = [&, this](Progress& progress) {
      const int all = flags_.threads > 0 ? flags_.threads : thread_limit();
      const ThreadLimit threads(std::max(1, all / flags_.jobs));
      RunFlags flags;
      flags.command = flags_.command;
      flags.resume = true;
      flags.overwrite = flags_.overwrite;
      return polar::run(run_config, flags, progress, engine_).cancelled ? kStopped : 0;
    };
    if (flags_.part == BatchPart::data_sets)
      pipeline::remove_dataset_end(file(pipeline::kBatchTasks), rows_[i].name);
    rows_[i].state = "running";
    progress_.note(rows_[i].name + ": begins");
    running_.push_back({i, std::make_unique<ChildProcess>(progress_, work)});
  }

  void listen() {
    std::vector<pollfd> descriptors;
    for (const Running& r : running_) descriptors.push_back({r.process->descriptor(), POLLIN, 0});
    if (::poll(descriptors.data(), descriptors.size(), kRefresh_ms) <= 0) return;
    std::vector<Running> still;
    for (std::size_t k = 0; k < running_.size(); ++k) {
      Running& r = running_[k];
      const std::string& name = rows_[r.dataset].name;
      const auto note = [&](const std::string& line) { progress_.note(name + ": " + line); };
      if (descriptors[k].revents == 0 || r.process->receive(note))
        still.push_back(std::move(r));
      else
        end(r);
    }
    running_ = std::move(still);
  }

  void end(Running& r) {
    const ChildProcess::End end = r.process->end();
    DatasetRow& row = rows_[r.dataset];
    ++ended_;
    if (end.reported && end.code == kStopped) {
      row.state = "stopped";
      leave_word(r.dataset);
    } else if (end.reported && end.code == 0) {
      row.state = "done";
      load_summary(r.dataset);
      progress_.note(row.name + ": done");
    } else {
      fail(r.dataset, end.code, end.text);
    }
    write_tables();
  }

  // Once: a second signal would end them at once.
  void stop() {
    if (stopping_) return;
    stopping_ = true;
    for (const Running& r : running_) r.process->signal(SIGTERM);
  }

  void write_tables() const {
    if (flags_.part == BatchPart::data_sets) return;
    smlm::write_file_atomically(file(pipeline::kBatchSummary), pipeline::batch_summary_csv(rows_));
    smlm::write_file_atomically(file(pipeline::kBatchConditions),
                                pipeline::batch_conditions_csv(rows_, config_.bootstrap));
    smlm::write_file_atomically(file(pipeline::kBatchState),
                                pipeline::json_text(pipeline::batch_json(rows_, config_.bootstrap)));
  }

  // In a process of its own, too: drawing starts threads, and this process must have none when it forks.
  void write_page() {
    if (flags_.part == BatchPart::data_sets) return;
    const auto work = [this](Progress&) {
      const ThreadLimit threads(flags_.threads > 0 ? flags_.threads : thread_limit());
      write_batch_report(config_.directory, file(kReportFile), report_name(config_.directory));
      return 0;
    };
    ChildProcess page(progress_, work);
    while (page.receive([this](const std::string& line) { progress_.note(line); })) {
    }
    const ChildProcess::End end = page.end();
    if (end.reported && end.code == 0) return;
    page_fault_ = end.text;
    progress_.note(std::string(kReportFile) + ": failed: " + end.text);
  }

  BatchOutcome outcome() const {
    BatchOutcome o;
    if (!page_fault_.empty()) {
      o.some_failed = true;
      o.summary.push_back(std::string("failed       ") + kReportFile + ": " + page_fault_);
    }
    std::size_t done = 0, kept = 0, stopped = 0;
    for (const DatasetRow& row : rows_) {
      done += row.state == "done" ? 1 : 0;
      kept += row.state == "kept" ? 1 : 0;
      stopped += row.state == "stopped" ? 1 : 0;
      if (!wanted(row.name)) continue;
      if (row.state == "failed") o.summary.push_back("failed       " + row.name + ": " + row.reason);
      if (row.state == "stopped") o.summary.push_back("stopped      " + row.name + ": " + kGoesOn);
      o.some_failed = o.some_failed || row.state == "failed" || row.state == "stopped";
    }
    o.cancelled = progress_.cancelled() && (!waiting_.empty() || stopped > 0);
    o.summary.insert(o.summary.begin(), "data sets    " + std::to_string(done) + " done, " +
                                            std::to_string(kept) + " kept, of " +
                                            std::to_string(rows_.size()));
    o.summary.push_back("results      " + config_.directory);
    return o;
  }

  const BatchConfig& config_;
  const BatchFlags& flags_;
  Progress& progress_;
  const Engine& engine_;
  std::vector<DatasetRow> rows_;
  std::vector<std::size_t> waiting_;
  std::vector<Running> running_;
  std::size_t ended_ = 0, total_ = 0;
  bool stopping_ = false;
  std::string page_fault_;  // why the page could not be written
};
}  // namespace

bool is_wanted(const BatchFlags& flags, const std::string& name) {
  return flags.only.empty() || std::find(flags.only.begin(), flags.only.end(), name) != flags.only.end();
}

void require_known_names(const BatchConfig& config, const BatchFlags& flags) {
  std::vector<std::string> names;
  for (const DatasetConfig& d : config.datasets) names.push_back(d.name);
  for (const std::string& name : flags.only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw smlm::Error(smlm::Fault::usage, "--only " + name, "no such data set",
                        "did you mean '" + pipeline::nearest_word(name, names) + "'?");
}

BatchOutcome run_batch(const BatchConfig& config, const BatchFlags& flags, Progress& progress,
                       const Engine& engine) {
  return Batch(config, flags, progress, engine).run();
}

}  // namespace polar
