#include "plot.hpp"

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace polar::report {

namespace {
constexpr double kLeft = 46, kRight = 12, kTop = 26, kBottom = 40;
constexpr double kMargin = 0.05;  // of an axis, beyond the values
constexpr double kTicks = 5;
constexpr int kMostDecimals = 3;     // of a tick; smaller steps are written in significant digits
constexpr double kHalfLetter = 3.8;  // units, of the letters below an axis

std::vector<std::pair<double, std::string>> round_ticks(const Axis& axis) {
  const double step = round_step((axis.high - axis.low) / kTicks);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::vector<std::pair<double, std::string>> ticks;
  for (double k = std::ceil(axis.low / step - 1e-9); k * step <= axis.high + 1e-9 * step; ++k)
    ticks.emplace_back(k * step, std::abs(axis.high) < 1e6 && decimals <= kMostDecimals
                                     ? fixed(k * step, decimals)
                                     : digits(k * step, 2));
  return ticks;
}
}  // namespace

Axis axis_of(const std::vector<double>& values, const std::string& label) {
  const std::vector<double> sorted = sorted_finite(values);
  if (sorted.empty()) return {0, 1, label};
  const double spread = sorted.back() - sorted.front();
  const double margin = spread > 0 ? kMargin * spread : std::max(0.1 * std::abs(sorted.back()), 1e-6);
  return {sorted.front() - margin, sorted.back() + margin, label};
}

Plot::Plot(const Axis& x, const Axis& y) : x_(x), y_(y), drawing_(kWidth, kHeight) { draw_axes(); }

double Plot::across(double x) const {
  const double share = std::clamp((x - x_.low) / (x_.high - x_.low), -0.02, 1.02);
  return kLeft + share * (kWidth - kLeft - kRight);
}

double Plot::up(double y) const {
  const double share = std::clamp((y - y_.low) / (y_.high - y_.low), -0.02, 1.02);
  return kHeight - kBottom - share * (kHeight - kTop - kBottom);
}

void Plot::draw_axes() {
  Path grid;
  for (const auto& [value, name] : y_.ticks.empty() ? round_ticks(y_) : y_.ticks) {
    grid.move(kLeft, up(value)).line(kWidth - kRight, up(value));
    drawing_.text("tick", kLeft - 5, up(value) + 4, name, Anchor::end);
  }
  drawing_.path("grid", grid);
  Path marks;
  for (const auto& [value, name] : x_.ticks.empty() ? round_ticks(x_) : x_.ticks) {
    marks.move(across(value), kHeight - kBottom).line(across(value), kHeight - kBottom + 4);
    const double most = kWidth - kHalfLetter * static_cast<double>(name.size());  // or it would be cut off
    drawing_.text("tick", std::min(across(value), most), kHeight - kBottom + 16, name, Anchor::middle);
  }
  marks.move(kLeft, kHeight - kBottom).line(kWidth - kRight, kHeight - kBottom);
  drawing_.path("axis", marks);
  drawing_.text("axis-name", kWidth - kRight, kHeight - 6, x_.label, Anchor::end);
  drawing_.text("axis-name", 4, 12, y_.label);
}

void Plot::line(const std::string& style, const std::vector<double>& x, const std::vector<double>& y) {
  Path path;
  bool drawing = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const bool here = std::isfinite(x[i]) && std::isfinite(y[i]);
    if (here && drawing) path.line(across(x[i]), up(y[i]));
    if (here && !drawing) path.move(across(x[i]), up(y[i]));
    drawing = here;
  }
  drawing_.path("line " + style, path);
}

void Plot::error_bar(const std::string& style, double x, double low, double middle, double high) {
  if (!std::isfinite(middle)) return;
  if (std::isfinite(low) && std::isfinite(high))
    drawing_.path("line " + style, Path().move(across(x), up(low)).line(across(x), up(high)));
  drawing_.path("dots " + style, Path().dot(across(x), up(middle)));
}

void Plot::dots(const std::string& style, const std::vector<double>& x, const std::vector<double>& y) {
  Path path;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) path.dot(across(x[i]), up(y[i]));
  drawing_.path("dots " + style, path);
}

void Plot::bars(const std::string& style, const Histogram& h) {
  for (std::size_t b = 0; b < h.count.size(); ++b) {
    if (h.count[b] == 0) continue;
    const double left = across(h.edge(b)), right = across(h.edge(b + 1)),
                 top = up(static_cast<double>(h.count[b]));
    drawing_.rect(
        "fill " + style, left, top, std::max(0.5, right - left - 0.6), up(0) - top,
        digits(h.edge(b), 4) + " to " + digits(h.edge(b + 1), 4) + ": " + std::to_string(h.count[b]));
  }
}

void Plot::vertical(const std::string& style, double x, const std::string& name) {
  drawing_.path(style, Path().move(across(x), kTop - 6).line(across(x), kHeight - kBottom));
  const bool right = across(x) > kWidth / 2;
  drawing_.text("cut-name", across(x) + (right ? -4 : 4), kTop + 2, name,
                right ? Anchor::end : Anchor::start);
}

void Plot::horizontal(const std::string& style, double y, const std::string& name) {
  drawing_.path(style, Path().move(kLeft, up(y)).line(kWidth - kRight, up(y)));
  drawing_.text("cut-name", kWidth - kRight - 2, up(y) - 4, name, Anchor::end);
}

void Plot::legend(const std::vector<std::pair<std::string, std::string>>& style_and_name) {
  double x = kWidth - kRight;
  for (auto entry = style_and_name.rbegin(); entry != style_and_name.rend(); ++entry) {
    drawing_.text("legend", x, 12, entry->second, Anchor::end);
    x -= 6.4 * static_cast<double>(entry->second.size()) + 6;
    drawing_.path("line " + entry->first, Path().move(x - 12, 8).line(x, 8));
    x -= 24;
  }
}

std::string histogram_svg(const Histogram& h, const std::string& x_label, const std::string& y_label,
                          const std::string& style, const std::vector<std::pair<double, std::string>>& cuts,
                          const Histogram* accepted) {
  double low = h.low, high = h.high();
  for (const auto& [value, name] : cuts) low = std::min(low, value), high = std::max(high, value);
  const double margin = 0.01 * (high - low);
  Plot plot({low - (low < h.low ? margin : 0), high + (high > h.high() ? margin : 0), x_label},
            {0, 1.08 * static_cast<double>(std::max<std::size_t>(h.highest(), 1)), y_label});
  plot.bars(style, h);
  if (accepted != nullptr) {
    plot.bars("c1", *accepted);
    plot.legend({{"c1", "accepted"}, {style, "rejected"}});
  }
  for (const auto& [value, name] : cuts) plot.vertical("cut", value, name);
  return plot.svg(x_label + ": histogram of " + std::to_string(h.total) + " values");
}

}  // namespace polar::report
