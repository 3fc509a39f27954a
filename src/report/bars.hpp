// Named values, one line each: bars from zero, or dots where zero means nothing, with intervals.
#pragma once

#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"

namespace polar::report {

struct Bar {
  std::string name;
  double value = 0;
  std::string shown;                                   // the value in words
  double low = PoseRow::kNone, high = PoseRow::kNone;  // interval; none where NaN
  std::string style = "c1";
};

/// `from_zero`: bars; else dots on a range that holds all values.
std::string bars_svg(const std::vector<Bar>& bars, const std::string& label, bool from_zero = true);

}  // namespace polar::report
