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

struct Running {
  std::size_t dataset;
  std::unique_ptr<ChildProcess> process;
};

class Batch {
 public:
  Batch(const BatchConfig& config, const BatchFlags& flags, Progress& progress, const Engine& engine)
      : config_(config), flags_(flags), progress_(progress), engine_(engine) {
    require_known_names();
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
  void require_known_names() const {
    std::vector<std::string> names;
    for (const DatasetConfig& d : config_.datasets) names.push_back(d.name);
    for (const std::string& name : flags_.only)
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw smlm::Error(smlm::Fault::usage, "--only " + name, "no such data set",
                          "did you mean '" + pipeline::nearest_word(name, names) + "'?");
  }

  bool wanted(const std::string& name) const {
    return flags_.only.empty() ||
           std::find(flags_.only.begin(), flags_.only.end(), name) != flags_.only.end();
  }

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
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const DatasetConfig& d = config_.datasets[i];
      bool complete = false;
      if (d.fault.empty()) {
        try {
          complete = is_complete(d.run);
        } catch (const smlm::Error& e) {
          fail(i, e.exit_code(), e.what());
          continue;
        }
      } else {
        fail(i, d.fault_code, d.fault);
        continue;
      }
      if (complete) {
        rows_[i].state = "kept";
        load_summary(i);
      } else if (wanted(d.name)) {
        waiting_.push_back(i);
      }
    }
  }

  void fail(std::size_t i, int code, const std::string& reason) {
    rows_[i].state = "failed";
    rows_[i].exit_code = code;
    rows_[i].reason = reason;
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
      (flags_.overwrite ? flags.overwrite : flags.resume) = true;
      return polar::run(run_config, flags, progress, engine_).cancelled ? kStopped : 0;
    };
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
    smlm::write_file_atomically(file(pipeline::kBatchSummary), pipeline::batch_summary_csv(rows_));
    smlm::write_file_atomically(file(pipeline::kBatchConditions),
                                pipeline::batch_conditions_csv(rows_, config_.bootstrap));
    smlm::write_file_atomically(file(pipeline::kBatchState),
                                pipeline::json_text(pipeline::batch_json(rows_, config_.bootstrap)));
  }

  // In a process of its own, too: drawing starts threads, and this process must have none when it forks.
  void write_page() {
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
    o.cancelled = progress_.cancelled() && (!waiting_.empty() || stopping_);
    std::size_t done = 0, kept = 0;
    for (const DatasetRow& row : rows_) {
      done += row.state == "done" ? 1 : 0;
      kept += row.state == "kept" ? 1 : 0;
      if (row.state != "failed" || !wanted(row.name)) continue;
      o.some_failed = true;
      o.summary.push_back("failed       " + row.name + ": " + row.reason);
    }
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

BatchOutcome run_batch(const BatchConfig& config, const BatchFlags& flags, Progress& progress,
                       const Engine& engine) {
  return Batch(config, flags, progress, engine).run();
}

}  // namespace polar
