#include "polar/results/star.hpp"

#include <cmath>

#include "csv_line.hpp"
#include "polar/core/constants.hpp"

namespace polar {

namespace {
constexpr double kNoTilt = 1e-9;  // sine below which rot and psi turn about the same axis
// RELION reads no optics group, and then none of the poses, without a voltage and a spherical aberration.
// Light has neither and no image is here that they could touch: a voltage it knows and no aberration.
constexpr const char* kOptics =
    "\ndata_optics\n\nloop_\n_rlnOpticsGroup #1\n_rlnOpticsGroupName #2\n_rlnImagePixelSize #3\n"
    "_rlnImageDimensionality #4\n_rlnVoltage #5\n_rlnSphericalAberration #6\n_rlnAmplitudeContrast #7\n"
    "1 nanometres 10.0 3 300.0 0.0 0.1\n\n";
constexpr const char* kColumns[] = {
    "rlnTomoParticleName", "rlnCoordinateX",  "rlnCoordinateY",           "rlnCoordinateZ",
    "rlnOriginXAngst",     "rlnOriginYAngst", "rlnOriginZAngst",          "rlnAngleRot",
    "rlnAngleTilt",        "rlnAnglePsi",     "rlnLogLikeliContribution", "rlnOpticsGroup"};

// A word of a STAR file: in quotes where blanks or what begins a comment or text would end it.
std::string word(const std::string& text) {
  if (!text.empty() && text.find_first_of(" \t\r\n'\"#;$_[]") == std::string::npos) return text;
  std::string clean;
  for (const char c : text) clean += c == '\n' || c == '\r' ? ' ' : c == '"' ? '\'' : c;
  return '"' + clean + '"';
}

std::string number(double value) {
  return std::isfinite(value) ? results::csv_number(value) : std::string("0");
}
}  // namespace

// A = Rz(psi) Ry(tilt) Rz(rot) in RELION's sense of turning the axes, so A(2,:) = (sin tilt cos rot,
// sin tilt sin rot, cos tilt) and A(:,2) = (-sin tilt cos psi, sin tilt sin psi, cos tilt).
RelionAngles relion_angles(const Eigen::Matrix3d& a) {
  const double sine = std::hypot(a(2, 0), a(2, 1));
  RelionAngles angles;
  angles.tilt_deg = kDegreesPerRadian * std::atan2(sine, a(2, 2));
  if (sine > kNoTilt) {
    angles.rot_deg = kDegreesPerRadian * std::atan2(a(2, 1), a(2, 0));
    angles.psi_deg = kDegreesPerRadian * std::atan2(a(1, 2), -a(0, 2));
  } else {  // only rot + psi (upright) or psi - rot (upside down) is determined
    angles.psi_deg =
        kDegreesPerRadian * (a(2, 2) > 0 ? std::atan2(-a(1, 0), a(0, 0)) : std::atan2(a(1, 0), -a(0, 0)));
  }
  return angles;
}

std::string format_star(const std::vector<PoseRow>& rows) {
  std::string text = std::string("# x_particle = Rz(psi) Ry(tilt) Rz(rot) x_template + coordinate\n") +
                     kOptics + "\ndata_particles\n\nloop_\n";
  int column = 0;
  for (const char* name : kColumns) text += "_" + std::string(name) + " #" + std::to_string(++column) + "\n";
  for (const PoseRow& row : rows) {
    if (!row.accepted || !row.template_from_view) continue;
    const Pose view_from_template = row.template_from_view->inverse();
    const RelionAngles angles = relion_angles(view_from_template.rotation);
    text += word(row.particle);
    for (int axis = 0; axis < 3; ++axis) text += " " + number(view_from_template.translation[axis]);
    text += " 0 0 0";
    for (const double value : {angles.rot_deg, angles.tilt_deg, angles.psi_deg, row.log_likelihood})
      text += " " + number(value);
    text += " 1\n";
  }
  return text + "\n";
}

}  // namespace polar
