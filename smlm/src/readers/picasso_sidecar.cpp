#include "picasso_sidecar.hpp"

#include <charconv>
#include <filesystem>
#include <string_view>

#include "../text/line_reader.hpp"

namespace smlm::readers {
namespace {

constexpr std::string_view key = "Pixelsize:";
constexpr double largest_pixel_nm = 1e6;

std::optional<double> pixel_size_in(std::string_view line) {
  if (line.substr(0, key.size()) != key) return std::nullopt;
  line.remove_prefix(key.size());
  line = line.substr(0, line.find(" #"));
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || first == 0) return std::nullopt;
  line = line.substr(first, line.find_last_not_of(" \t") - first + 1);
  double value = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  const bool number = error == std::errc() && end == line.data() + line.size();
  return number && value > 0 && value < largest_pixel_nm ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

std::string picasso_sidecar_path(const std::string& hdf5_path) {
  return std::filesystem::path(hdf5_path).replace_extension(".yaml").string();
}

std::optional<double> picasso_pixel_size_nm(const std::string& sidecar_path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(sidecar_path, error)) return std::nullopt;
  LineReader lines(sidecar_path);
  std::optional<double> pixel_size_nm;
  for (std::string_view line; lines.next(line);) {
    if (const auto found = pixel_size_in(line)) pixel_size_nm = found;
  }
  return pixel_size_nm;
}

}  // namespace smlm::readers
