#include "reporter.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "signals.hpp"

namespace polar::cli {

namespace {
constexpr auto kRefresh = std::chrono::milliseconds(200);

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

void print_json(nlohmann::json line) {
  line["time_s"] = seconds(std::chrono::system_clock::now().time_since_epoch());
  std::fprintf(stderr, "%s\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}
}  // namespace

ReportStyle choose_style(bool quiet, bool json) {
  if (json) return ReportStyle::json;
  if (quiet) return ReportStyle::quiet;
  const char* kind = std::getenv("TERM");  // without one, or a dumb one, no line is drawn over another
  const bool draws = kind != nullptr && *kind != '\0' && std::strcmp(kind, "dumb") != 0;
  return draws && ::isatty(STDERR_FILENO) ? ReportStyle::terminal : ReportStyle::plain;
}

void Reporter::step(const std::string& stage, int done, int total) {
  const auto now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    stage_first_ = done;  // work that goes on from a checkpoint does not begin at 0
    last_shown_ = {};
  }
  if (now - last_shown_ < kRefresh && done < total) return;
  last_shown_ = now;
  const double elapsed = seconds(now - stage_start_);
  const double rate = elapsed > 0 ? (done - stage_first_) / elapsed : 0;
  const double left = rate > 0 ? (total - done) / rate : 0;
  if (style_ == ReportStyle::json)
    print_json({{"event", "progress"},
                {"stage", stage},
                {"done", done},
                {"total", total},
                {"rate_per_s", rate},
                {"eta_s", left}});
  if (style_ != ReportStyle::terminal) return;
  std::fprintf(stderr, "\r\033[K%s %d/%d  %.1f/s  %.0f s left", stage.c_str(), done, total, rate, left);
  std::fflush(stderr);
  line_shown_ = true;
}

void Reporter::note(const std::string& line) {
  if (style_ == ReportStyle::quiet) return;
  if (style_ == ReportStyle::json) return print_json({{"event", "note"}, {"text", line}});
  clear_line();
  std::fprintf(stderr, "%s\n", line.c_str());
}

bool Reporter::cancelled() const { return received_signal() != 0; }

void Reporter::clear_line() {
  if (line_shown_) std::fprintf(stderr, "\r\033[K");
  line_shown_ = false;
}

}  // namespace polar::cli
