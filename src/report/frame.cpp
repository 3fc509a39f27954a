#include "frame.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "polar/core/median.hpp"
#include "polar/results/results.hpp"
#include "section.hpp"

namespace polar::report {

namespace {
// The two extents across an axis differ by less: a body of revolution, or of many-fold symmetry.
constexpr double kAxialRatio = 1.15;

Eigen::Vector3d middle_of(const smlm::LocalisationTable& t) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < (t.planar ? 2u : 3u); ++axis) {
    std::vector<double> along;
    for (const auto& x : t.position_nm) along.push_back(x[axis]);
    middle[static_cast<Eigen::Index>(axis)] = quantile(std::move(along), 0.5);
  }
  return middle;
}

bool has_axis(const SymmetryRecord& s) {
  return s.group.size() > 1 && (s.group[0] == 'C' || s.group[0] == 'D') && s.group != "C1";
}

// Rows: the drawn axes. Each points towards the template's axis that it is nearest to, so that a template
// that lies along its axes already is drawn as it is.
Eigen::Matrix3d turned(const Eigen::Vector3d& z, const Eigen::Vector3d& x_wish) {
  Eigen::Vector3d up = z.normalized();
  if (up.minCoeff() < -up.maxCoeff()) up = -up;
  Eigen::Vector3d across = x_wish - x_wish.dot(up) * up;
  if (across.norm() < 1e-6) across = up.unitOrthogonal();
  across.normalize();
  if (across.minCoeff() < -across.maxCoeff()) across = -across;
  Eigen::Matrix3d rotation;
  rotation.row(0) = across.transpose();
  rotation.row(1) = up.cross(across).transpose();
  rotation.row(2) = up.transpose();
  return rotation;
}

DrawingFrame about(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& centre) {
  DrawingFrame frame;
  frame.drawn_from_template = {rotation, -(rotation * centre)};
  return frame;
}
}  // namespace

DrawingFrame drawing_frame(const RunRecord& record) {
  const smlm::LocalisationTable& t = record.result.superparticle;
  DrawingFrame frame;
  if (t.size() == 0) {
    frame.sentence = "No particle has a pose: nothing is drawn.";
    return frame;
  }
  const Eigen::Vector3d middle = middle_of(t);
  if (t.planar) {
    frame = about(Eigen::Matrix3d::Identity(), middle);
    frame.sentence = "Drawn as in the files, about its middle.";
    return frame;
  }
  if (record.symmetry && has_axis(*record.symmetry)) {
    frame = about(record.symmetry->rotation, record.symmetry->centre_nm);
    frame.axial = true;
    frame.sentence = "Drawn with its symmetry axis (" + record.symmetry->group + ") along z.";
    return frame;
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& x : t.position_nm) {
    const Eigen::Vector3d d = Eigen::Vector3d(x[0], x[1], x[2]) - middle;
    spread += d * d.transpose() / static_cast<double>(t.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Eigen::Vector3d extent = axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
  const bool shortest = extent[1] / extent[0] > extent[2] / extent[1];  // differs most from the other two
  const Eigen::Vector3d z = axes.eigenvectors().col(shortest ? 0 : 2);
  frame.axial = (shortest ? extent[2] / extent[1] : extent[1] / extent[0]) < kAxialRatio;
  // About an axis of revolution every x is as good: the template's own, as near as may be.
  Eigen::Index least = 0;
  z.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d x_wish = frame.axial ? Eigen::Vector3d(Eigen::Vector3d::Unit(least))
                                             : Eigen::Vector3d(axes.eigenvectors().col(shortest ? 2 : 1));
  const bool axial = frame.axial;
  frame = about(turned(z, x_wish), middle);
  frame.axial = axial;
  frame.sentence = std::string("Drawn along its principal axes, z the ") +
                   (shortest ? "shortest" : "longest") + "; the files keep the template's own frame.";
  return frame;
}

Subject::Subject(const RunRecord& r)
    : record(r), frame(drawing_frame(r)), points(moved(r.result.superparticle, frame.drawn_from_template)) {}

}  // namespace polar::report
