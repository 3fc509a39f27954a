#include "canvas.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar::results {

namespace {
constexpr std::size_t kGlyphWidth = 5, kGlyphHeight = 7;

// Rows from the top, the lowest five bits from left to right.
const std::map<char, std::array<std::uint8_t, kGlyphHeight>>& glyphs() {
  static const std::map<char, std::array<std::uint8_t, kGlyphHeight>> table = {
      {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
      {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
      {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
      {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
      {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
      {'.', {0, 0, 0, 0, 0, 12, 12}},      {'n', {0, 0, 22, 25, 17, 17, 17}},
      {'m', {0, 0, 26, 21, 21, 21, 21}},   {'u', {0, 0, 17, 17, 17, 19, 13}},
      {'x', {0, 0, 17, 10, 4, 10, 17}},    {'y', {0, 0, 17, 17, 15, 1, 14}},
      {'z', {0, 0, 31, 2, 4, 8, 31}},
  };
  return table;
}

std::uint8_t channel(double value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}
void flush(png_structp) {}
}  // namespace

Colour heat(double value) { return {channel(3 * value), channel(3 * value - 1), channel(3 * value - 2)}; }

void Canvas::set(std::size_t x, std::size_t y, Colour c) {
  if (x >= width_ || y >= height_) return;
  std::uint8_t* at = &rgb_[3 * (y * width_ + x)];
  at[0] = c.red;
  at[1] = c.green;
  at[2] = c.blue;
}

void Canvas::fill(std::size_t x, std::size_t y, std::size_t width, std::size_t height, Colour c) {
  for (std::size_t v = y; v < y + height; ++v)
    for (std::size_t u = x; u < x + width; ++u) set(u, v, c);
}

void Canvas::text(std::size_t x, std::size_t y, const std::string& line, std::size_t scale, Colour c) {
  for (const char letter : line) {
    const auto glyph = glyphs().find(letter);
    if (glyph != glyphs().end())
      for (std::size_t row = 0; row < kGlyphHeight; ++row)
        for (std::size_t column = 0; column < kGlyphWidth; ++column)
          if (glyph->second[row] >> (kGlyphWidth - 1 - column) & 1)
            fill(x + scale * column, y + scale * row, scale, scale, c);
    x += (kGlyphWidth + 1) * scale;
  }
}

std::string Canvas::png() const {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    throw smlm::Error(smlm::Fault::resource, "picture", "could not be encoded");
  }
  png_set_write_fn(png, &bytes, append, flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width_), static_cast<png_uint_32>(height_), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (std::size_t y = 0; y < height_; ++y) png_write_row(png, &rgb_[3 * y * width_]);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

void Canvas::write_png(const std::string& path) const { smlm::write_file_atomically(path, png()); }

}  // namespace polar::results
