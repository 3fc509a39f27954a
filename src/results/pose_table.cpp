#include "polar/results/pose_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "csv_line.hpp"
#include "smlm/error.hpp"
#include "smlm/regular_file.hpp"

namespace polar {

namespace {
using results::csv_field;
using results::csv_number;

constexpr const char* kHeader =
    "particle,n_localisations,n_used,accepted,reason,qw,qx,qy,qz,tx_nm,ty_nm,tz_nm,"
    "rotation_std_deg,translation_std_nm,log_likelihood,margin";
constexpr std::array<const char*, 7> kPoseColumns = {"qw", "qx", "qy", "qz", "tx_nm", "ty_nm", "tz_nm"};
constexpr double kUnitTolerance = 1e-3;  // quaternions written with three digits are still accepted

std::string pose_fields(const std::optional<Pose>& pose) {
  if (!pose) return ",,,,,,";
  Eigen::Quaterniond q(pose->rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d& t = pose->translation;
  std::string text;
  for (const double v : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()})
    text += (text.empty() ? "" : ",") + csv_number(v);
  return text;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {
    std::error_code unseen;
    if (std::filesystem::exists(path, unseen)) smlm::require_regular_file(path);
    in_.open(path);
    std::string header;
    if (!in_)
      throw smlm::Error(smlm::Fault::input, path, "cannot be opened",
                        "give a poses.csv or a result directory");
    next(header);
    if (header.rfind("\xEF\xBB\xBF", 0) == 0) header.erase(0, 3);  // what spreadsheets put before UTF-8
    // Where the decimal comma is at home, spreadsheets separate by semicolons.
    if (header.find(',') == std::string::npos && header.find(';') != std::string::npos) delimiter_ = ';';
    const std::vector<std::string> names = results::split_csv(header, delimiter_);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!column_.emplace(names[i], i).second) fail("column '" + names[i] + "' occurs twice");
    require("particle");
    for (const char* name : kPoseColumns) require(name);
  }

  std::vector<PoseRow> rows() {
    std::vector<PoseRow> rows;
    for (std::string line; next(line);) {
      if (line.empty() || line == "\r") continue;
      field_ = results::split_csv(line, delimiter_);
      if (field_.size() != column_.size())
        fail("has " + std::to_string(field_.size()) + " fields, the header " +
             std::to_string(column_.size()));
      rows.push_back(row());
    }
    return rows;
  }

 private:
  bool next(std::string& line) {
    ++line_;
    return static_cast<bool>(std::getline(in_, line));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw smlm::Error(smlm::Fault::input, path_ + ":" + std::to_string(line_), what,
                      "expected the columns of poses.csv (docs/formats.md)");
  }
  void require(const char* name) const {
    if (column_.count(name) == 0) fail(std::string("column '") + name + "' is missing");
  }
  std::string text(const char* name) const {
    const auto found = column_.find(name);
    return found == column_.end() ? std::string() : field_[found->second];
  }
  double number(const char* name) const {
    std::string value = text(name);
    if (value.empty()) return PoseRow::kNone;
    if (delimiter_ == ';') std::replace(value.begin(), value.end(), ',', '.');
    double parsed = 0;
    const auto end = std::from_chars(value.data(), value.data() + value.size(), parsed);
    if (end.ec != std::errc() || end.ptr != value.data() + value.size())
      fail(std::string(name) + " is '" + value + "', not a number");
    return parsed;
  }
  std::uint64_t count(const char* name) const {
    const double value = number(name);
    return value >= 0 && value < 1e18 ? static_cast<std::uint64_t>(value) : 0;
  }
  PoseRow row() const {
    PoseRow r;
    r.particle = text("particle");
    r.n_localisations = count("n_localisations");
    r.n_used = count("n_used");
    r.reason = text("reason");
    r.rotation_std_deg = number("rotation_std_deg");
    r.translation_std_nm = number("translation_std_nm");
    r.log_likelihood = number("log_likelihood");
    r.margin = number("margin");
    std::array<double, 7> v{};
    int present = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = number(kPoseColumns[i]);
      present += std::isfinite(v[i]) ? 1 : 0;
    }
    if (present > 0) {
      if (present < 7) fail("has an incomplete pose");
      const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
      if (std::abs(q.norm() - 1) > kUnitTolerance) fail("has a quaternion that is not of length 1");
      r.template_from_view = Pose{q.normalized().toRotationMatrix(), {v[4], v[5], v[6]}};
    }
    const std::string accepted = text("accepted");
    r.accepted = column_.count("accepted") ? accepted == "1" || accepted == "TRUE" || accepted == "True"
                                           : r.template_from_view.has_value();
    return r;
  }

  std::string path_;
  std::ifstream in_;
  std::size_t line_ = 0;
  char delimiter_ = ',';
  std::map<std::string, std::size_t> column_;
  std::vector<std::string> field_;
};
}  // namespace

std::string format_pose_table(const std::vector<PoseRow>& rows) {
  std::string text = std::string(kHeader) + "\n";
  for (const PoseRow& r : rows) {
    text += csv_field(r.particle) + "," + std::to_string(r.n_localisations) + "," + std::to_string(r.n_used) +
            "," + (r.accepted ? "1" : "0") + "," + csv_field(r.reason) + "," +
            pose_fields(r.template_from_view);
    for (const double v : {r.rotation_std_deg, r.translation_std_nm, r.log_likelihood, r.margin})
      text += "," + csv_number(v);
    text += "\n";
  }
  return text;
}

std::vector<PoseRow> read_pose_table(const std::string& path) { return Reader(path).rows(); }

}  // namespace polar
