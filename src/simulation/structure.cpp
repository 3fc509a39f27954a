#include "polar/simulation/structure.hpp"

#include <cmath>

#include "polar/core/constants.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {

// Nup96 (Thevathasan et al. 2019).
constexpr double kPoreRadius_nm = 53.5, kPoreSeparation_nm = 50.0, kCornerPair_nm = 12.0,
                 kPoreTwist_deg = 8.8;
// Centriole (after Winey and O'Toole 2014).
constexpr double kTubuleA_nm = 85.0, kTubulePitch_nm = 20.0, kTripletLean_deg = 50.0;
constexpr double kCentrioleLength_nm = 400.0, kCentrioleStep_nm = 20.0;
constexpr double kPolyhedron_nm = 43.0, kRing_nm = 50.0;

double or_default(double value, double fallback) { return value > 0 ? value : fallback; }
int or_default(int value, int fallback) { return value > 0 ? value : fallback; }

Eigen::Matrix3Xd as_matrix(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd m(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) m.col(static_cast<Eigen::Index>(i)) = points[i];
  return m;
}

Eigen::Vector3d on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Structure nuclear_pore(const StructureOptions& o) {
  const double radius = or_default(o.radius_nm, kPoreRadius_nm);
  const double half = or_default(o.length_nm, kPoreSeparation_nm) / 2;
  const int units = or_default(o.units, 8);
  const double pair = std::asin(std::min(1.0, kCornerPair_nm / 2 / radius));
  std::vector<Eigen::Vector3d> site;
  for (const double side : {1.0, -1.0})
    for (int u = 0; u < units; ++u)
      for (const double member : {1.0, -1.0})  // symmetric about x: a half turn about x swaps the rings
        site.push_back(on_circle(
            radius, 2 * kPi * u / units + side * kPoreTwist_deg * kRadiansPerDegree / 2 + member * pair,
            side * half));
  return {"nuclear_pore", as_matrix(site), "D" + std::to_string(units)};
}

Structure centriole(const StructureOptions& o) {
  const double radius = or_default(o.radius_nm, kTubuleA_nm);
  const double length = or_default(o.length_nm, kCentrioleLength_nm);
  const int units = or_default(o.units, 9);
  const int steps = static_cast<int>(std::floor(length / kCentrioleStep_nm));
  std::vector<Eigen::Vector3d> site;
  for (int u = 0; u < units; ++u) {
    const double angle = 2 * kPi * u / units;
    const Eigen::Vector3d outward = on_circle(1, angle, 0), along = on_circle(1, angle + kPi / 2, 0);
    const Eigen::Vector3d blade = std::cos(kTripletLean_deg * kRadiansPerDegree) * along +
                                  std::sin(kTripletLean_deg * kRadiansPerDegree) * outward;
    for (int tubule = 0; tubule < 3; ++tubule)
      for (int s = 0; s <= steps; ++s)
        site.push_back(radius * outward + tubule * kTubulePitch_nm * blade +
                       Eigen::Vector3d(0, 0, (s - steps / 2.0) * kCentrioleStep_nm));
  }
  return {"centriole", as_matrix(site), "C" + std::to_string(units)};
}

Structure polyhedron(const StructureOptions& o, bool whole_cube) {
  const double a = or_default(o.radius_nm, kPolyhedron_nm) / std::sqrt(3.0);
  std::vector<Eigen::Vector3d> site;
  for (int v = 0; v < 8; ++v) {
    const int x = v & 1 ? 1 : -1, y = v & 2 ? 1 : -1, z = v & 4 ? 1 : -1;
    if (whole_cube || x * y * z > 0) site.push_back(a * Eigen::Vector3d(x, y, z));
  }
  return {whole_cube ? "cube" : "tetrahedron", as_matrix(site), whole_cube ? "O" : "T"};
}

Structure ring(const StructureOptions& o) {
  const int units = or_default(o.units, 8);
  std::vector<Eigen::Vector3d> site;
  site.reserve(static_cast<std::size_t>(units));
  for (int u = 0; u < units; ++u)
    site.push_back(on_circle(or_default(o.radius_nm, kRing_nm), 2 * kPi * u / units, 0));
  return {"ring", as_matrix(site), "D" + std::to_string(units)};
}
}  // namespace

double Structure::radius_nm() const { return site_nm.cols() == 0 ? 0 : site_nm.colwise().norm().maxCoeff(); }

std::vector<std::string> violations(const StructureOptions& o) {
  std::vector<std::string> faults;
  const bool known = o.kind == "nuclear_pore" || o.kind == "centriole" || o.kind == "tetrahedron" ||
                     o.kind == "cube" || o.kind == "ring";
  if (!known)
    faults.push_back("structure.kind is '" + o.kind +
                     "', expected nuclear_pore, centriole, tetrahedron, cube, ring or file");
  if (!(o.radius_nm >= 0)) faults.push_back("structure.radius_nm must be 0 or more");
  if (!(o.length_nm >= 0)) faults.push_back("structure.length_nm must be 0 or more");
  if (o.units < 0 || o.units == 1 || o.units > 1000)
    faults.push_back("structure.units must be 0 (the kind's own) or 2 to 1000");
  return faults;
}

Structure make_structure(const StructureOptions& options) {
  smlm::throw_if_any(violations(options), smlm::Fault::usage, "");
  if (options.kind == "nuclear_pore") return nuclear_pore(options);
  if (options.kind == "centriole") return centriole(options);
  if (options.kind == "ring") return ring(options);
  return polyhedron(options, options.kind == "cube");
}

Structure centred(Structure structure, double radius_nm) {
  const Eigen::Vector3d mean = structure.site_nm.rowwise().mean();
  structure.site_nm.colwise() -= mean;
  const double radius = structure.radius_nm();
  if (radius_nm > 0 && radius > 0) structure.site_nm *= radius_nm / radius;
  return structure;
}

}  // namespace polar
