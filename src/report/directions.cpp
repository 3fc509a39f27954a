// From where the particles were seen.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "plot.hpp"
#include "polar/core/constants.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr double kSure = 3;  // standard errors beyond which a direction is not even
constexpr std::size_t kMostDots = 4000;

// drawn_from_view rotations of the accepted particles.
std::vector<Eigen::Matrix3d> rotations(const Subject& subject) {
  std::vector<Eigen::Matrix3d> found;
  for (const PoseRow& p : subject.record.poses)
    if (p.accepted)
      found.push_back(subject.frame.drawn_from_template.rotation * p.template_from_view->rotation);
  return found;
}

// Both hemispheres in equal area (Lambert): equally many dots a surface where directions are even.
std::string sphere_svg(const std::vector<Eigen::Matrix3d>& turns) {
  constexpr double kWidth = 360, kHeight = 200, kRadius = 82, kMiddle = 100;
  Drawing drawing(kWidth, kHeight);
  const double centre[2] = {90, 270};
  for (const double x : centre) {
    drawing.path("disc", Path().circle(x, kMiddle, kRadius));
    drawing.path("grid", Path()
                             .circle(x, kMiddle, kRadius * std::sqrt(2.0) * std::sin(kPi / 12))
                             .circle(x, kMiddle, kRadius * std::sqrt(2.0) * std::sin(kPi / 6))
                             .move(x - kRadius, kMiddle)
                             .line(x + kRadius, kMiddle)
                             .move(x, kMiddle - kRadius)
                             .line(x, kMiddle + kRadius));
  }
  drawing.text("legend", centre[0], 12, "from above (+z)", Anchor::middle);
  drawing.text("legend", centre[1], 12, "from below (-z)", Anchor::middle);
  drawing.text("tick", centre[0] + kRadius - 2, kMiddle - 4, "x", Anchor::end);
  drawing.text("tick", centre[0] + 4, kMiddle - kRadius + 10, "y");
  Path dots;
  const std::size_t stride = turns.size() / kMostDots + 1;
  for (std::size_t i = 0; i < turns.size(); i += stride) {
    const Eigen::Vector3d d = turns[i].col(2);  // the optical axis, seen by the structure
    const double scale = kRadius / std::sqrt(1 + std::abs(d.z()));
    dots.dot(centre[d.z() >= 0 ? 0 : 1] + scale * d.x(), kMiddle - scale * d.y());
  }
  drawing.path(turns.size() > 800 ? "dots small c1" : "dots c1", dots);
  return drawing.svg("viewing directions of " + counted(turns.size(), "particle") + " on the sphere");
}

// The second moment of the directions: thirds where they are even.
std::string anisotropy(const std::vector<Eigen::Matrix3d>& turns) {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& r : turns) moment += r.col(2) * r.col(2).transpose();
  const auto n = static_cast<double>(turns.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moment / n);
  const Eigen::Vector3d share = axes.eigenvalues();
  const std::string shares = digits(share[2], 2) + ", " + digits(share[1], 2) + ", " + digits(share[0], 2);
  // Of a uniform direction's squared component: mean 1/3, variance 4/45.
  const double error = std::sqrt(4.0 / 45 / n);
  const std::string numbers = " Shares of the directions along three axes: " + shares +
                              " (even: 0.33 each, standard error " + digits(error, 2) + ").";
  if (share[2] - 1.0 / 3 < kSure * error && 1.0 / 3 - share[0] < kSure * error)
    return "The viewing directions are even, as far as so many particles tell." + numbers;
  const bool gathered = share[2] - share[1] > share[1] - share[0];
  const Eigen::Vector3d axis = axes.eigenvectors().col(gathered ? 2 : 0).cwiseAbs();
  const std::string named =
      "(" + fixed(axis.x(), 2) + " " + fixed(axis.y(), 2) + " " + fixed(axis.z(), 2) + ", signs left out)";
  return (gathered ? "Anisotropic, gathered: most particles are seen along one axis " + named +
                         ", so that what lies along it is known from the axial coordinate only."
                   : "Anisotropic, a belt: few particles are seen along one axis " + named + ".") +
         numbers;
}

Figure angle_figure(const char* id, const std::string& title, const std::vector<double>& degrees, double high,
                    const std::string& label, const std::string& caption) {
  return {id, title, histogram_svg(histogram_between(degrees, 0, high, 18), label, "particles", "c1"),
          caption};
}
}  // namespace

Section directions_section(const Subject& subject) {
  Section s{"directions", "Viewing directions", {}, {}, {}};
  const std::vector<Eigen::Matrix3d> turns = rotations(subject);
  if (turns.empty()) {
    s.figures.push_back(absent("sphere", "On the sphere", "No particle has a pose."));
    return s;
  }
  std::vector<double> tilt, in_plane;
  for (const Eigen::Matrix3d& r : turns) {
    tilt.push_back(kDegreesPerRadian * std::acos(std::min(1.0, std::max(-1.0, r(2, 2)))));
    // Where the structure's z points in the image plane; for upright particles the turn itself.
    const double angle = subject.points.planar || std::hypot(r(2, 0), r(2, 1)) < 1e-6
                             ? std::atan2(r(0, 1), r(0, 0))
                             : std::atan2(r(2, 1), r(2, 0));
    in_plane.push_back(kDegreesPerRadian * (angle < 0 ? angle + kTwoPi : angle));
  }
  if (subject.points.planar) {
    s.figures.push_back(absent("sphere", "On the sphere",
                               "The data are planar: every particle is seen from the same "
                               "side, turned in the plane only."));
  } else {
    s.notes.push_back(anisotropy(turns));
    if (subject.record.symmetry && subject.record.symmetry->group != "C1")
      s.notes.push_back("The structure has the symmetry " + subject.record.symmetry->group +
                        ": directions that differ by one of its turns are the same view.");
    s.figures.push_back(
        {"sphere", "On the sphere", sphere_svg(turns),
         "The optical axis as each particle saw it, in equal area; circles 30 and 60 degrees from z."});
    s.figures.push_back(angle_figure("tilt", "Tilt", tilt, 180, "tilt of z against the optical axis [deg]",
                                     "Even directions follow the sine: most at 90 degrees."));
  }
  s.figures.push_back(angle_figure(
      "in-plane", "In the image plane", in_plane, 360, "angle [deg]",
      subject.points.planar ? "The turn of each particle." : "Azimuth of the structure's z in the image."));
  return s;
}

}  // namespace polar::report
