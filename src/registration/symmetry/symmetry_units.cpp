#include "symmetry_units.hpp"

#include <cmath>

#include "polar/core/symmetry_group.hpp"
#include "polar/fusion/orbits.hpp"

namespace polar {

namespace {

constexpr double kReach = 0.1;    // particle radii, in which the density of a spot is counted
constexpr double kOnAxis = 0.05;  // particle radii: a spot so near to an axis lies on it
constexpr double kSamePoint = 1e-6;

Eigen::Matrix3Xd images(const Eigen::Vector3d& x, const RotationGroup& group) {
  Eigen::Matrix3Xd out(3, 0);
  for (const Eigen::Matrix3d& g : group) {
    const Eigen::Vector3d image = g * x;
    if (out.cols() > 0 && (out.colwise() - image).colwise().norm().minCoeff() < kSamePoint) continue;
    out.conservativeResize(3, out.cols() + 1);
    out.col(out.cols() - 1) = image;
  }
  return out;
}

// The centre with most of the template's weight around it and around its images.
Eigen::Vector3d densest(const Eigen::Matrix3Xd& centre, const Eigen::VectorXd& weight,
                        const RotationGroup& group) {
  Eigen::VectorXd density = Eigen::VectorXd::Zero(centre.cols());
  for (const Eigen::Matrix3d& g : group) {
    const Eigen::Matrix3Xd image = g * centre;
    for (Eigen::Index k = 0; k < centre.cols(); ++k)
      density[k] +=
          ((image.colwise() - centre.col(k)).colwise().squaredNorm().transpose().array() < kReach * kReach)
              .select(weight.array(), 0.0)
              .sum();
  }
  Eigen::Index at = 0;
  density.maxCoeff(&at);
  return centre.col(at);
}

}  // namespace

void count_units(const Problem& problem, Registration& r) {
  Symmetry& s = *r.symmetry;
  if (s.group == "C1" || s.group == "SO3" || s.group.find("inf") != std::string::npos) return;
  const RotationGroup group = symmetry_rotations(s.group);
  const Pose& to = s.canonical_from_template;
  Eigen::Matrix3Xd centre = (to.rotation * r.fused.centre).colwise() + to.translation;
  const Eigen::Matrix3Xd unit =
      images(onto_axes(densest(centre, r.fused.weight, group), group, kOnAxis), group);
  std::vector<double> count(static_cast<std::size_t>(unit.cols()), 0.0);
  double total = 0;
  for (std::size_t i = 0; i < r.view.size(); ++i) {
    if (!r.view[i].accepted) continue;
    const Pose pose = to * r.view[i].template_from_view;
    const Eigen::Matrix3Xf& points = problem.views.view[i].points;
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      Eigen::Index at = 0;
      (unit.colwise() - pose * points.col(j).cast<double>()).colwise().squaredNorm().minCoeff(&at);
      ++count[static_cast<std::size_t>(at)], ++total;
    }
  }
  for (double& c : count) c /= std::max(1.0, total);
  s.unit_share = std::move(count);
  const Pose back = to.inverse();
  s.unit = (back.rotation * unit).colwise() + back.translation;
}

}  // namespace polar
