#include "picasso_sidecar.hpp"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

constexpr std::uintmax_t largest_bytes = 16 << 20;
constexpr int deepest = 64;

// yaml-cpp recurses on nested flow collections, so brackets are counted before it sees them. Quotes and
// comments are not told apart: that can only refuse what no sidecar holds.
bool too_deep(const std::string& text) {
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest) return true;
  }
  return false;
}

// Indentation also nests: no sidecar is indented by more than a few levels.
bool too_indented(const std::string& text) {
  std::size_t blanks = 0;
  std::size_t markers = 0;
  bool at_start = true;
  for (const char c : text) {
    if (c == '\n') {
      blanks = markers = 0;
      at_start = true;
    } else if (at_start && c == ' ') {
      ++blanks;
    } else if (at_start && (c == '-' || c == '?' || c == ':')) {
      ++markers;
    } else {
      at_start = false;
    }
    if (blanks > 4 * deepest || markers > deepest) return true;
  }
  return false;
}

}  // namespace

std::string picasso_sidecar_path(const std::string& hdf5_path) {
  return std::filesystem::path(hdf5_path).replace_extension(".yaml").string();
}

std::optional<double> picasso_pixel_size_nm(const std::string& sidecar_path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(sidecar_path, error)) return std::nullopt;
  if (std::filesystem::file_size(sidecar_path, error) > largest_bytes) {
    throw Error(Fault::input, sidecar_path, "is larger than 16 MiB", "is it Picasso's?");
  }
  std::ifstream file(sidecar_path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (too_deep(text) || too_indented(text)) {
    throw Error(Fault::input, sidecar_path, "is nested too deeply", "is it Picasso's?");
  }
  std::optional<double> pixel_size_nm;
  try {
    for (const YAML::Node& document : YAML::LoadAll(text)) {
      if (!document.IsMap()) continue;
      const YAML::Node value = document["Pixelsize"];
      if (!value.IsDefined() || !value.IsScalar()) continue;
      const std::string& number = value.Scalar();
      double parsed = 0;
      const auto [end, bad] = std::from_chars(number.data(), number.data() + number.size(), parsed);
      if (bad == std::errc() && end == number.data() + number.size() && parsed > 0 && parsed < 1e6) {
        pixel_size_nm = parsed;
      }
    }
  } catch (const YAML::Exception& exception) {
    throw Error(Fault::input, sidecar_path + ":" + std::to_string(exception.mark.line + 1), exception.msg,
                "correct the file, or remove it and set input.pixel_size_nm");
  }
  return pixel_size_nm;
}

}  // namespace smlm::readers
