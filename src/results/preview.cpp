#include "polar/results/preview.hpp"

#include <algorithm>
#include <cmath>

#include "canvas.hpp"
#include "scale_bar.hpp"

namespace polar {

namespace {
using results::Canvas;
using results::Colour;
using results::length_label;
using results::round_length;

constexpr std::size_t kPanel_px = 360;  // longest edge of the largest panel
constexpr std::size_t kGap_px = 12, kText = 2, kLegend_px = 44, kBar_px = 6;
constexpr double kGamma = 0.6;      // brightens weak parts
constexpr double kBarShare = 0.35;  // longest scale bar, of the first panel's width
constexpr Colour kWhite = {255, 255, 255}, kFrame = {70, 70, 70};

// A projection: value(u, v), u to the right, v upwards.
struct Panel {
  std::size_t width = 0, height = 0;  // voxels
  std::vector<float> value;
  const char* across = "";
  const char* up = "";
};

Panel project(const Volume& v, std::size_t across, std::size_t up, const char* across_name,
              const char* up_name) {
  Panel p{v.size[across], v.size[up], std::vector<float>(v.size[across] * v.size[up], 0.0f), across_name,
          up_name};
  std::array<std::size_t, 3> i{};
  for (i[2] = 0; i[2] < v.size[2]; ++i[2])
    for (i[1] = 0; i[1] < v.size[1]; ++i[1])
      for (i[0] = 0; i[0] < v.size[0]; ++i[0]) {
        float& at = p.value[i[up] * p.width + i[across]];
        at = std::max(at, v.at(i[0], i[1], i[2]));
      }
  return p;
}

// Bilinear, at voxel coordinates (voxel centres are whole numbers).
double sample(const Panel& p, double u, double v) {
  u = std::clamp(u, 0.0, static_cast<double>(p.width - 1));
  v = std::clamp(v, 0.0, static_cast<double>(p.height - 1));
  const auto u0 = static_cast<std::size_t>(u), v0 = static_cast<std::size_t>(v);
  const std::size_t u1 = std::min(u0 + 1, p.width - 1), v1 = std::min(v0 + 1, p.height - 1);
  const double fu = u - static_cast<double>(u0), fv = v - static_cast<double>(v0);
  const auto at = [&](std::size_t x, std::size_t y) { return double(p.value[y * p.width + x]); };
  return (1 - fv) * ((1 - fu) * at(u0, v0) + fu * at(u1, v0)) +
         fv * ((1 - fu) * at(u0, v1) + fu * at(u1, v1));
}

// Colours of several channels; two that meet add up to a third.
constexpr Colour kChannel[] = {{0, 255, 0},   {255, 0, 255}, {0, 255, 255},
                               {255, 255, 0}, {255, 80, 0},  {0, 80, 255}};

Colour channel_colour(std::size_t channel) {
  return kChannel[channel % (sizeof kChannel / sizeof *kChannel)];
}

// What one channel alone shows in one direction, and its brightest value in any.
struct Layer {
  Panel panel;
  double brightest = 0;
};

Colour blended(const std::vector<Layer>& layers, double u, double v) {
  double red = 0, green = 0, blue = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const double brightest = layers[i].brightest;
    const double share = std::pow(brightest > 0 ? sample(layers[i].panel, u, v) / brightest : 0, kGamma);
    if (layers.size() == 1) return results::heat(share);
    const Colour c = channel_colour(i);
    red += share * c.red, green += share * c.green, blue += share * c.blue;
  }
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(std::min(value, 255.0)));
  };
  return {byte(red), byte(green), byte(blue)};
}

void draw(Canvas& canvas, const std::vector<Layer>& layers, std::size_t left, double zoom) {
  const Panel& p = layers.front().panel;
  const auto width = static_cast<std::size_t>(std::lround(zoom * static_cast<double>(p.width)));
  const auto height = static_cast<std::size_t>(std::lround(zoom * static_cast<double>(p.height)));
  canvas.fill(left - 1, kGap_px - 1, width + 2, height + 2, kFrame);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const double u = (static_cast<double>(x) + 0.5) / zoom - 0.5;
      const double v = (static_cast<double>(height - 1 - y) + 0.5) / zoom - 0.5;
      canvas.set(left + x, kGap_px + y, blended(layers, u, v));
    }
  canvas.text(left + 4, kGap_px + 4, std::string(p.across) + p.up, kText, kWhite);
}
}  // namespace

void write_preview_png(const std::string& path, const std::vector<ChannelVolume>& channels) {
  std::vector<std::vector<Layer>> panels(channels.front().volume.planar ? 1 : 3);
  for (const ChannelVolume& channel : channels) {
    const Volume& v = channel.volume;
    panels[0].push_back({project(v, 0, 1, "x", "y")});
    if (panels.size() > 1) {
      panels[1].push_back({project(v, 0, 2, "x", "z")});
      panels[2].push_back({project(v, 1, 2, "y", "z")});
    }
    double brightest = 0;
    for (const auto& layers : panels)
      for (const float value : layers.back().panel.value) brightest = std::max(brightest, double(value));
    for (auto& layers : panels) layers.back().brightest = brightest;
  }
  std::size_t longest = 1, tallest = 1;
  for (const auto& layers : panels) {
    longest = std::max({longest, layers[0].panel.width, layers[0].panel.height});
    tallest = std::max(tallest, layers[0].panel.height);
  }
  const double zoom = static_cast<double>(kPanel_px) / static_cast<double>(longest);
  const auto scaled = [&](std::size_t voxels) {
    return static_cast<std::size_t>(std::lround(zoom * static_cast<double>(voxels)));
  };
  std::size_t width = kGap_px;
  for (const auto& layers : panels) width += scaled(layers[0].panel.width) + kGap_px;
  const std::size_t bottom = kGap_px + scaled(tallest);
  const double pixels_per_nm = zoom / channels.front().volume.voxel_nm;
  const double bar_nm = round_length(kBarShare * static_cast<double>(scaled(longest)) / pixels_per_nm);
  const std::string label = length_label(bar_nm);
  const auto bar_px = static_cast<std::size_t>(std::lround(bar_nm * pixels_per_nm));
  width = std::max(width, 2 * kGap_px + std::max(bar_px, Canvas::text_width(label, kText)));
  Canvas canvas(width, bottom + kLegend_px);
  std::size_t left = kGap_px;
  for (const auto& layers : panels) {
    draw(canvas, layers, left, zoom);
    left += scaled(layers[0].panel.width) + kGap_px;
  }
  canvas.fill(kGap_px, bottom + kGap_px, bar_px, kBar_px, kWhite);
  canvas.text(kGap_px, bottom + kGap_px + kBar_px + 4, label, kText, kWhite);
  canvas.write_png(path);
}

}  // namespace polar
