#include "raster.hpp"

#include <algorithm>
#include <cmath>

#include "base64.hpp"
#include "drawing.hpp"
#include "results/canvas.hpp"
#include "results/scale_bar.hpp"

namespace polar::report {

namespace {
constexpr double kGamma = 0.6;  // as in preview.png
constexpr double kWidth = 300, kLongest = 300;
constexpr double kBarShare = 0.35;  // longest scale bar, of the picture's width

results::Colour mixed(double red, double green, double blue) {
  const auto channel = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
  };
  return {channel(red), channel(green), channel(blue)};
}

double brightness(double value, double brightest) {
  return brightest > 0 ? std::pow(std::clamp(value / brightest, 0.0, 1.0), kGamma) : 0.0;
}
}  // namespace

double Raster::largest() const { return value.empty() ? 0 : *std::max_element(value.begin(), value.end()); }

Raster summed(const Volume& v, const Plane& plane, std::size_t begin, std::size_t end) {
  Raster r;
  r.width = v.size[plane.across], r.height = v.size[plane.up], r.pixel_nm = v.voxel_nm;
  r.origin_nm = {v.origin_nm[plane.across], v.origin_nm[plane.up]};
  r.value.assign(r.width * r.height, 0.0);
  std::array<std::size_t, 3> i{};
  for (i[plane.through] = begin; i[plane.through] < end; ++i[plane.through])
    for (i[plane.up] = 0; i[plane.up] < r.height; ++i[plane.up])
      for (i[plane.across] = 0; i[plane.across] < r.width; ++i[plane.across])
        r.value[i[plane.up] * r.width + i[plane.across]] += double(v.at(i[0], i[1], i[2]));
  return r;
}

std::string heat_png(const Raster& r, double brightest) {
  results::Canvas canvas(r.width, r.height);
  for (std::size_t y = 0; y < r.height; ++y)
    for (std::size_t x = 0; x < r.width; ++x)
      canvas.set(x, r.height - 1 - y, results::heat(brightness(r.value[y * r.width + x], brightest)));
  return canvas.png();
}

std::string tinted_png(const std::vector<Raster>& rasters, const std::vector<Tint>& tints,
                       const std::vector<double>& brightest) {
  const Raster& first = rasters.front();
  results::Canvas canvas(first.width, first.height);
  for (std::size_t y = 0; y < first.height; ++y)
    for (std::size_t x = 0; x < first.width; ++x) {
      Tint sum = {0, 0, 0};
      for (std::size_t c = 0; c < rasters.size(); ++c)
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += tints[c][k] * brightness(rasters[c].value[y * first.width + x], brightest[c]);
      canvas.set(x, first.height - 1 - y, mixed(sum[0], sum[1], sum[2]));
    }
  return canvas.png();
}

std::string picture_svg(const Raster& r, const std::string& png, const char* axes, const std::string& label,
                        const std::vector<std::pair<std::string, std::string>>& legend) {
  const double longest = static_cast<double>(std::max(r.width, r.height));
  const double width = kLongest * static_cast<double>(r.width) / longest,
               height = kLongest * static_cast<double>(r.height) / longest;
  // Every picture of a page is as wide as the others, so that letters are of one size.
  Drawing drawing(kWidth, height);
  const double left = (kWidth - width) / 2;
  drawing.rect("ground", 0, 0, kWidth, height);
  drawing.image(left, 0, width, height, png_uri(png));
  const double units_per_nm = kLongest / (longest * r.pixel_nm);
  const double bar_nm = results::round_length(kBarShare * kLongest / units_per_nm);
  drawing.rect("scale-bar", 8, height - 12, bar_nm * units_per_nm, 4);
  drawing.text("on-picture", 8, height - 18, results::length_label(bar_nm));
  drawing.text("on-picture", 8, 18, axes);
  double y = 18;
  for (const auto& [style, name] : legend) {
    drawing.text("on-picture " + style, kWidth - 8, y, name, Anchor::end);
    y += 15;
  }
  return drawing.svg(label);
}

}  // namespace polar::report
