#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/results/mrc.hpp"
#include "polar/results/star.hpp"
#include "smlm/error.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

using ::testing::HasSubstr;

template <class T>
T word(const std::string& bytes, std::size_t number) {
  T value{};
  std::memcpy(&value, bytes.data() + 4 * (number - 1), sizeof value);
  return value;
}

TEST(Mrc, HeaderAndValues) {
  const support::TemporaryDirectory directory;
  const Volume v{{2, 3, 1}, {-1.5, 2, 10}, 2.5, false, {0, 1, 2, 3, 4, 5}};
  write_mrc(directory.path("a.mrc"), v);
  std::ifstream in(directory.path("a.mrc"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  ASSERT_EQ(bytes.size(), 1024 + 6 * 4u);
  EXPECT_EQ(word<std::int32_t>(bytes, 1), 2);
  EXPECT_EQ(word<std::int32_t>(bytes, 2), 3);
  EXPECT_EQ(word<std::int32_t>(bytes, 4), 2) << "32-bit floats";
  EXPECT_FLOAT_EQ(word<float>(bytes, 12), 75) << "three voxels of 25 angstrom";
  EXPECT_FLOAT_EQ(word<float>(bytes, 20), 0);
  EXPECT_FLOAT_EQ(word<float>(bytes, 21), 5);
  EXPECT_FLOAT_EQ(word<float>(bytes, 22), 2.5);
  EXPECT_EQ(word<std::int32_t>(bytes, 23), 1);
  EXPECT_FLOAT_EQ(word<float>(bytes, 50), -15);
  EXPECT_EQ(bytes.substr(208, 4), "MAP ");
  // ChimeraX and IMOD know the byte order by the stamp and the mode, the voxel by cell over sampling, the
  // axes by words 17 to 19; both refuse, or skip, what an extended header of the wrong length would shift.
  EXPECT_EQ(bytes.substr(212, 4), std::string("DD\0\0", 4));
  EXPECT_EQ(word<std::int32_t>(bytes, 24), 0) << "no extended header";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(word<std::int32_t>(bytes, 5 + axis), 0) << "starts at the origin, which words 50 to 52 place";
    EXPECT_EQ(word<std::int32_t>(bytes, 8 + axis), word<std::int32_t>(bytes, 1 + axis));
    EXPECT_FLOAT_EQ(word<float>(bytes, 14 + axis), 90);
    EXPECT_EQ(word<std::int32_t>(bytes, 17 + axis), static_cast<std::int32_t>(axis) + 1);
  }
  EXPECT_EQ(word<std::int32_t>(bytes, 28), 20141) << "MRC2014, second revision";
  EXPECT_EQ(word<std::int32_t>(bytes, 56), 1) << "label";
  EXPECT_FLOAT_EQ(word<float>(bytes, 256 + 4), 3);
  EXPECT_THROW(write_mrc(directory.path("no/a.mrc"), v), smlm::Error);
}

// RELION's matrix, built from its three turns of the axes.
Eigen::Matrix3d relion_matrix(const RelionAngles& a) {
  const auto about_z = [](double deg) {
    const double c = std::cos(deg * kRadiansPerDegree), s = std::sin(deg * kRadiansPerDegree);
    Eigen::Matrix3d m;
    m << c, s, 0, -s, c, 0, 0, 0, 1;
    return m;
  };
  const double c = std::cos(a.tilt_deg * kRadiansPerDegree), s = std::sin(a.tilt_deg * kRadiansPerDegree);
  Eigen::Matrix3d about_y;
  about_y << c, 0, -s, 0, 1, 0, s, 0, c;
  return about_z(a.psi_deg) * about_y * about_z(a.rot_deg);
}

TEST(Star, AnglesGiveTheRotationBack) {
  KeyedRandom random(5, 0, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d r = random.rotation();
    EXPECT_LT(geodesic_angle(relion_matrix(relion_angles(r)), r), 1e-6);
  }
  for (const double turn : {-2.0, 0.0, 0.7}) {
    const Eigen::Matrix3d upright = so3_exp({0, 0, turn}), down = so3_exp({kPi, 0, 0}) * upright;
    EXPECT_LT(geodesic_angle(relion_matrix(relion_angles(upright)), upright), 1e-6);
    EXPECT_LT(geodesic_angle(relion_matrix(relion_angles(down)), down), 1e-6);
  }
}

TEST(Star, HoldsAcceptedParticlesOnly) {
  PoseRow a;
  a.particle = "cell 1:3";
  a.accepted = true;
  a.template_from_view = Pose{so3_exp({0, 0, kPi / 2}), {10, 0, 0}};
  PoseRow b;
  b.particle = "rejected";
  const std::string text = format_star({a, b});
  // x = R^T (0 - t) = -R^T (10, 0, 0) = (0, 10, 0)
  EXPECT_THAT(text, HasSubstr("\n\"cell 1:3\" "));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("rejected")));
  EXPECT_THAT(text, HasSubstr("_rlnAngleTilt #9\n"));
  for (const char* needed : {"_rlnImagePixelSize #3\n", "_rlnVoltage #5\n", "_rlnSphericalAberration #6\n"})
    EXPECT_THAT(text, HasSubstr(needed)) << "without it RELION reads no optics group";
  EXPECT_THAT(text, HasSubstr(" 10 0 0 0 0 "));
}

}  // namespace
}  // namespace polar
