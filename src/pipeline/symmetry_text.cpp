#include "symmetry_text.hpp"

#include <algorithm>
#include <cstdio>

namespace polar::pipeline {

namespace {
nlohmann::json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
}  // namespace

std::string symmetry_line(const Symmetry& s, double scale_nm) {
  std::string line = "symmetry     " + s.group + (s.asked ? " as asked" : " found") +
                     (s.in_use || s.group == "C1" ? "" : ", the average is without it");
  if (s.group == "C1") return line;
  char text[200];
  const Eigen::Vector3d axis = s.axis(), centre = scale_nm * s.centre();
  std::snprintf(text, sizeof text,
                " (held-out %+.4f +- %.4f), axis (%.3f %.3f %.3f) through (%.1f %.1f %.1f) nm", s.gain,
                s.gain_std, axis.x(), axis.y(), axis.z(), centre.x(), centre.y(), centre.z());
  line += text;
  if (!s.unit_share.empty()) {
    const auto [least, most] = std::minmax_element(s.unit_share.begin(), s.unit_share.end());
    std::snprintf(text, sizeof text, "; %zu units hold %.1f to %.1f %% of the localisations each",
                  s.unit_share.size(), 100 * *least, 100 * *most);
    line += text;
  }
  return line;
}

nlohmann::json symmetry_json(const Symmetry& s, double scale_nm) {
  nlohmann::json tried = nlohmann::json::array(), rotation = nlohmann::json::array(),
                 unit = nlohmann::json::array();
  for (const SymmetryTrial& t : s.tried)
    tried.push_back({{"group", t.group},
                     {"similarity", t.similarity},
                     {"held_out_gain", t.gain},
                     {"held_out_gain_std", t.gain_std}});
  for (Eigen::Index r = 0; r < 3; ++r)
    rotation.push_back(vector_json(s.canonical_from_template.rotation.row(r)));
  for (Eigen::Index k = 0; k < s.unit.cols(); ++k) unit.push_back(vector_json(scale_nm * s.unit.col(k)));
  return {{"group", s.group},
          {"imposed", s.in_use},
          {"asked", s.asked},
          {"axis", vector_json(s.axis())},
          {"centre_nm", vector_json(scale_nm * s.centre())},
          {"canonical_from_template", rotation},
          {"held_out_gain", s.gain},
          {"held_out_gain_std", s.gain_std},
          {"tried", tried},
          {"unit_nm", unit},
          {"unit_share", s.unit_share}};
}

}  // namespace polar::pipeline
