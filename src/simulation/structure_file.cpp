#include "polar/simulation/structure_file.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/isolation.hpp"
#include "smlm/points.hpp"

namespace polar {

namespace {
constexpr std::size_t kMostSites = 10'000'000;

[[noreturn]] void fail(const std::string& where, const std::string& what, const std::string& remedy = {}) {
  throw smlm::Error(smlm::Fault::input, where, what, remedy);
}

// The numbers at the start of a line, separated by commas, semicolons or blanks.
std::vector<double> leading_numbers(const std::string& line) {
  std::vector<double> values;
  const char *at = line.data(), *end = at + line.size();
  while (at != end) {
    if (*at == ' ' || *at == ',' || *at == ';' || *at == '\t' || *at == '\r') {
      ++at;
      continue;
    }
    double value = 0;
    const auto parsed = std::from_chars(at, end, value);
    if (parsed.ec != std::errc()) break;
    values.push_back(value);
    at = parsed.ptr;
  }
  return values;
}

Eigen::Matrix3Xd as_matrix(const std::vector<double>& flat) {
  return Eigen::Map<const Eigen::Matrix3Xd>(flat.data(), 3, static_cast<Eigen::Index>(flat.size() / 3));
}

Eigen::Matrix3Xd read_text(const std::string& path, std::size_t first_line, std::size_t most) {
  std::ifstream in(path);
  std::vector<double> flat;
  std::string line;
  for (std::size_t number = 1; flat.size() < 3 * most && std::getline(in, line); ++number) {
    if (number < first_line || line.empty() || line == "\r") continue;
    const std::vector<double> values = leading_numbers(line);
    if (number == 1 && values.empty()) continue;  // a header
    if (values.size() < 3) fail(path + ":" + std::to_string(number), "expected three numbers x, y, z");
    flat.insert(flat.end(), values.begin(), values.begin() + 3);
  }
  return as_matrix(flat);
}

Eigen::Matrix3Xd read_ply(const std::string& path) {
  std::ifstream in(path);
  std::size_t vertices = 0, line_number = 0;
  bool text = false;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "format") text = second == "ascii";
    if (first == "element" && second == "vertex") {
      const auto parsed = std::from_chars(third.data(), third.data() + third.size(), vertices);
      if (parsed.ec != std::errc() || vertices > kMostSites)
        fail(path, "unusable number of vertices '" + third + "'");
    }
    if (first == "end_header") break;
  }
  if (!text) fail(path, "not a PLY file in text form", "convert it to 'format ascii 1.0'");
  Eigen::Matrix3Xd points = read_text(path, line_number + 1, vertices);
  if (points.cols() != static_cast<Eigen::Index>(vertices)) fail(path, "ends before its last vertex");
  return points;
}

// Which row of the file: the shape called `label`, or the index-th whose label it is.
std::size_t choose(const smlm::h5::File& h5, const StructureFile& file, std::size_t shapes) {
  std::vector<std::size_t> candidates;
  if (file.label.empty()) {
    if (file.index < shapes) return file.index;
  } else {
    for (const char* column : {"/name", "/label"}) {
      if (!h5.exists(column)) continue;
      const std::vector<std::string> words = h5.read_strings(column);
      for (std::size_t i = 0; i < words.size() && i < shapes; ++i)
        if (words[i] == file.label) candidates.push_back(i);
      if (file.index < candidates.size()) return candidates[file.index];
    }
  }
  fail(file.path,
       "has no shape " + (file.label.empty() ? "" : "'" + file.label + "' ") + "number " +
           std::to_string(file.index),
       "it holds " + std::to_string(shapes) + " shapes, " + std::to_string(candidates.size()) +
           " of that label");
}

Structure read_shapes(const StructureFile& file) {
  const auto h5 = smlm::h5::File::open(file.path);
  if (!h5.exists("/points")) fail(file.path, "has no data set 'points'");
  const auto info = h5.info("/points");
  if (info.shape.size() != 3 || info.shape[2] != 3) fail(file.path + ":points", "expected shape x point x 3");
  const auto scales = h5.has_attribute("/points", "scale") ? h5.read_attribute<double>("/points", "scale")
                                                           : std::vector<double>{1.0};
  if (scales.size() != 1 || !(scales[0] > 0) || !std::isfinite(scales[0]))
    fail(file.path + ":points@scale", "expected one positive number");
  const std::size_t row = choose(h5, file, info.shape[0]), size = info.shape[1] * 3;
  const auto all = h5.read<double>("/points");
  std::vector<double> flat(all.begin() + static_cast<std::ptrdiff_t>(row * size),
                           all.begin() + static_cast<std::ptrdiff_t>((row + 1) * size));
  for (double& v : flat) v *= scales[0];
  Structure s;
  const auto names = h5.exists("/name") ? h5.read_strings("/name") : std::vector<std::string>{};
  s.name = row < names.size() ? names[row] : std::to_string(row);
  s.site_nm = as_matrix(flat);
  return s;
}
}  // namespace

// Whether a text holds nothing but three columns of numbers, without a header of any kind.
bool is_bare(const std::string& path) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    if (line[first] == '#' || line[first] == '%') return false;
    return leading_numbers(line).size() == 3;
  }
  return true;
}

// A table: its header says which columns are x, y and z, and in which unit.
Structure read_named(const std::string& path) {
  smlm::Points points = smlm::read_points(path, {});
  std::vector<double> flat;
  for (const auto& position : points.position_nm) flat.insert(flat.end(), position.begin(), position.end());
  Structure s;
  s.site_nm = as_matrix(flat);
  if (points.planar) points.warnings.emplace_back("has no z: the structure is flat");
  for (std::string& warning : points.warnings) s.warnings.push_back(path + ": " + warning);
  return s;
}

Structure read_structure(const StructureFile& file) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file.path, ec)) fail(file.path, "no such file");
  Structure s;
  if (smlm::h5::File::is_hdf5(file.path)) {
    s = smlm::read_isolated(file.path, [&] { return read_shapes(file); });
  } else {
    const std::filesystem::path path = file.path;
    if (path.extension() == ".ply") {
      s.site_nm = read_ply(file.path);
    } else if (is_bare(file.path)) {
      s.site_nm = read_text(file.path, 1, kMostSites);
    } else {
      s = read_named(file.path);
    }
    s.name = path.stem().string();
  }
  if (s.site_nm.cols() == 0) fail(file.path, "holds no points");
  if (!s.site_nm.allFinite()) fail(file.path, "holds a coordinate that is not a finite number");
  return centred(std::move(s), file.radius_nm);
}

}  // namespace polar
