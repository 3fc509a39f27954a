#include "contour.hpp"

namespace polar::report {

std::vector<std::array<double, 4>> contour(const Raster& r, double level) {
  std::vector<std::array<double, 4>> segments;
  // Corners of a cell and the edges between them, counter-clockwise from the lower left.
  constexpr std::array<std::array<std::size_t, 2>, 4> corner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t y = 0; y + 1 < r.height; ++y)
    for (std::size_t x = 0; x + 1 < r.width; ++x) {
      std::array<double, 4> above{};
      for (std::size_t k = 0; k < 4; ++k)
        above[k] = r.value[(y + corner[k][1]) * r.width + x + corner[k][0]] - level;
      std::vector<std::array<double, 2>> crossing;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        if ((above[k] > 0) == (above[next] > 0)) continue;
        const double share = above[k] / (above[k] - above[next]);
        std::array<double, 2> at{};
        for (std::size_t a = 0; a < 2; ++a)
          at[a] = r.origin_nm[a] +
                  r.pixel_nm *
                      (static_cast<double>(a == 0 ? x : y) + static_cast<double>(corner[k][a]) +
                       share * (static_cast<double>(corner[next][a]) - static_cast<double>(corner[k][a])));
        crossing.push_back(at);
      }
      // Four crossings are a saddle; either way of joining them outlines as well.
      for (std::size_t k = 0; k + 1 < crossing.size(); k += 2)
        segments.push_back({crossing[k][0], crossing[k][1], crossing[k + 1][0], crossing[k + 1][1]});
    }
  return segments;
}

}  // namespace polar::report
