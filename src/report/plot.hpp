// A plot with two axes: lines, dots, bars, cut-offs. 360 units wide, so that its letters can be read where a
// page is 400 pixels wide.
#pragma once

#include <string>
#include <vector>

#include "drawing.hpp"
#include "histogram.hpp"

namespace polar::report {

struct Axis {
  double low = 0, high = 1;
  std::string label;
  std::vector<std::pair<double, std::string>> ticks = {};  // none: at round numbers
};

/// From the least to the largest finite value with a margin; [0, 1] where there is none.
Axis axis_of(const std::vector<double>& values, const std::string& label);

class Plot {
 public:
  static constexpr double kWidth = 360, kHeight = 232;

  Plot(const Axis& x, const Axis& y);

  /// Broken where a value is not finite.
  void line(const std::string& style, const std::vector<double>& x, const std::vector<double>& y);
  /// From (x, low) to (x, high), with a dot at `middle`.
  void error_bar(const std::string& style, double x, double low, double middle, double high);
  void dots(const std::string& style, const std::vector<double>& x, const std::vector<double>& y);
  void bars(const std::string& style, const Histogram& histogram);
  /// Lines across the plot, named at their end.
  void vertical(const std::string& style, double x, const std::string& name);
  void horizontal(const std::string& style, double y, const std::string& name);
  /// Names of styles, in a line below the title.
  void legend(const std::vector<std::pair<std::string, std::string>>& style_and_name);

  std::string svg(const std::string& label) const { return drawing_.svg(label); }

 private:
  double across(double x) const;
  double up(double y) const;
  void draw_axes();

  Axis x_, y_;
  Drawing drawing_;
};

/// Bars of a histogram with axes and `cuts` (value, name). `accepted`: of the same bins, the part of them
/// that was accepted, drawn over the whole.
std::string histogram_svg(const Histogram& histogram, const std::string& x_label, const std::string& y_label,
                          const std::string& style,
                          const std::vector<std::pair<double, std::string>>& cuts = {},
                          const Histogram* accepted = nullptr);

}  // namespace polar::report
