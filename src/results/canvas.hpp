// A small greyscale-in, colour-out picture: enough for projections, a scale bar and a few letters.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace polar::results {

struct Colour {
  std::uint8_t red, green, blue;
};

/// Black, red, yellow, white with rising value in [0, 1].
Colour heat(double value);

class Canvas {
 public:
  Canvas(std::size_t width, std::size_t height)
      : width_(width), height_(height), rgb_(3 * width * height, 0) {}

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }

  /// Pixels outside are ignored.
  void set(std::size_t x, std::size_t y, Colour c);
  void fill(std::size_t x, std::size_t y, std::size_t width, std::size_t height, Colour c);
  /// Digits, '.', and the letters n, m, u, x, y, z in a 5 x 7 raster, `scale` pixels a dot.
  void text(std::size_t x, std::size_t y, const std::string& line, std::size_t scale, Colour c);
  static std::size_t text_width(const std::string& line, std::size_t scale) {
    return 6 * scale * line.size();
  }

  /// PNG, 8 bits a channel.
  std::string png() const;
  /// The same as a file, written whole or not at all. Throws smlm::Error (io).
  void write_png(const std::string& path) const;

 private:
  std::size_t width_, height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace polar::results
