#include <cmath>

#include "polar/simulation/simulate.hpp"

namespace polar {

namespace {
constexpr int kMostParticles = 1000000;
constexpr double kMostPoints = 1e6;

void check_range(std::vector<std::string>& faults, const std::string& key, const Range& r, double low,
                 double high) {
  if (!(r[0] >= low && r[1] >= r[0] && r[1] <= high && std::isfinite(r[1])))
    faults.push_back(key + " must be [low, high] within " + std::to_string(low) + " to " +
                     std::to_string(high));
}

void check_choice(std::vector<std::string>& faults, const std::string& key, const std::string& value,
                  const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& k : known) {
    if (k == value) return;
    list += (list.empty() ? "" : ", ") + k;
  }
  faults.push_back(key + " is '" + value + "', expected one of " + list);
}
}  // namespace

std::vector<std::string> violations(const SimulationOptions& o) {
  std::vector<std::string> faults;
  constexpr double kLength_nm = 1e7;
  const auto require = [&](bool holds, const char* sentence) {
    if (!holds) faults.emplace_back(sentence);
  };
  require(o.particles >= 1 && o.particles <= kMostParticles, "particles must be 1 to 1000000");
  check_choice(faults, "orientation", o.orientation, {"random_so3", "in_plane", "identity"});
  require(o.tilt_std_deg >= 0 && o.tilt_std_deg <= 90, "tilt_std_deg must be 0 to 90");
  check_choice(faults, "sampling", o.sampling, {"sites", "points"});
  require(o.labelling_efficiency > 0 && o.labelling_efficiency <= 1,
          "labelling_efficiency must be above 0, at most 1");
  require(o.blinks_mean >= 1 && o.blinks_mean <= 1e4, "blinks_mean must be 1 to 10000");
  check_choice(faults, "blinks", o.blinks, {"geometric", "poisson", "fixed"});
  check_range(faults, "points", o.points, 1, kMostPoints);
  require(o.label_size_nm >= 0 && o.label_size_nm <= kLength_nm, "label_size_nm must be 0 or more");
  check_range(faults, "sigma_xy_nm", o.sigma_xy_nm, 1e-6, kLength_nm);
  check_range(faults, "sigma_y_factor", o.sigma_y_factor, 1e-3, 1e3);
  check_range(faults, "sigma_z_factor", o.sigma_z_factor, 1e-3, 1e3);
  check_choice(faults, "sigma_per", o.sigma_per, {"localisation", "particle"});
  require(o.radius_std_nm >= 0 && o.radius_std_nm <= kLength_nm, "radius_std_nm must be 0 or more");
  require(o.height_std_nm >= 0 && o.height_std_nm <= kLength_nm, "height_std_nm must be 0 or more");
  require(!o.planar || o.height_std_nm == 0, "planar data have no height: height_std_nm must be 0");
  check_range(faults, "visibility", o.visibility, 0.01, 1);
  require(o.outlier_fraction >= 0 && o.outlier_fraction <= 0.95, "outlier_fraction must be 0 to 0.95");
  check_choice(faults, "outliers", o.outliers, {"uniform", "strands"});
  require(o.field_spacing_nm >= 0 && o.field_spacing_nm <= kLength_nm, "field_spacing_nm must be 0 or more");
  require(o.translation_nm >= 0 && o.translation_nm <= kLength_nm, "translation_nm must be 0 or more");
  require(!o.planar || (o.orientation != "random_so3" && o.tilt_std_deg == 0),
          "planar data need orientation in_plane or identity and no tilt");
  return faults;
}

}  // namespace polar
