// Progress on stderr: a line that rewrites itself on a terminal, JSON lines for programs, or nothing.
#pragma once

#include <chrono>
#include <string>

#include "polar/core/progress.hpp"

namespace polar::cli {

enum class ReportStyle { terminal, plain, json, quiet };

/// What fits: json or quiet when asked for, else terminal where stderr is one, else plain (notes only).
ReportStyle choose_style(bool quiet, bool json);

class Reporter : public Progress {
 public:
  explicit Reporter(ReportStyle style) : style_(style) {}
  ~Reporter() override { clear_line(); }

  void step(const std::string& stage, int done, int total) override;
  void note(const std::string& line) override;
  bool cancelled() const override;

 private:
  using Clock = std::chrono::steady_clock;
  void clear_line();

  ReportStyle style_;
  std::string stage_;
  Clock::time_point stage_start_{}, last_shown_{};
  int stage_first_ = 0;  // steps done when the stage was first heard of
  bool line_shown_ = false;
};

}  // namespace polar::cli
