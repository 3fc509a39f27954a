#include "bars.hpp"

#include <algorithm>
#include <cmath>

#include "drawing.hpp"
#include "plot.hpp"

namespace polar::report {

namespace {
constexpr double kWidth = 360, kLine = 34, kTop = 4, kLeft = 2, kRight = 4;
}  // namespace

std::string bars_svg(const std::vector<Bar>& bars, const std::string& label, bool from_zero) {
  std::vector<double> values;
  for (const Bar& b : bars)
    for (const double v : {b.value, b.low, b.high}) values.push_back(v);
  Axis axis = axis_of(values, label);
  if (from_zero) axis.low = 0, axis.high = std::max(axis.high, 1e-12);
  const auto across = [&](double v) {
    return kLeft + (kWidth - kLeft - kRight) * std::clamp((v - axis.low) / (axis.high - axis.low), 0.0, 1.0);
  };
  Drawing drawing(kWidth, kTop + kLine * static_cast<double>(bars.size()));
  double y = kTop;
  for (const Bar& b : bars) {
    drawing.text("bar-name", kLeft, y + 11, b.name);
    drawing.text("bar-value", kWidth - kRight, y + 11, b.shown, Anchor::end);
    if (from_zero) {
      drawing.rect("track", kLeft, y + 16, kWidth - kLeft - kRight, 8);
      drawing.rect("fill " + b.style, kLeft, y + 16, across(b.value) - kLeft, 8);
    } else {
      drawing.path("grid", Path().move(kLeft, y + 20).line(kWidth - kRight, y + 20));
      if (std::isfinite(b.value)) drawing.path("dots large " + b.style, Path().dot(across(b.value), y + 20));
    }
    if (std::isfinite(b.low) && std::isfinite(b.high)) {
      Path interval;
      interval.move(across(b.low), y + 20).line(across(b.high), y + 20);
      for (const double end : {b.low, b.high}) interval.move(across(end), y + 15).line(across(end), y + 25);
      drawing.path("interval", interval);
    }
    y += kLine;
  }
  return drawing.svg(label);
}

}  // namespace polar::report
