#include "registration/account/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/registration/register.hpp"
#include "scene.hpp"

namespace polar {
namespace {

Registration registered(const Views& views, std::uint64_t seed) {
  RegistrationOptions options;
  options.seed = seed;
  options.starts = {"random"};
  Progress silent;
  return register_views(views, options, silent);
}

int accepted(const Registration& r) {
  int n = 0;
  for (const RegisteredView& v : r.view) n += v.accepted ? 1 : 0;
  return n;
}

TEST(Verdict, pureNoiseIsNoStructure) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Views views;
    for (std::uint64_t i = 0; i < 30; ++i) {
      KeyedRandom random(seed, i, 7);
      View view;
      view.points.resize(3, 80);
      for (Eigen::Index j = 0; j < 80; ++j)
        for (int a = 0; a < 3; ++a) view.points(a, j) = static_cast<float>(0.5 * random.normal());
      view.covariance.assign(80, {0.0025f, 0, 0, 0.0025f, 0, 0.0025f});
      views.view.push_back(view);
    }
    const Registration r = registered(views, seed);
    EXPECT_EQ(r.verdict, Verdict::none) << seed << ": " << r.verdict_reason;
    EXPECT_EQ(accepted(r), 0) << seed;
  }
}

// The brightest label of every particle can be laid onto one place: no structure.
TEST(Verdict, labelsAnywhereThatBlinkAreNoStructure) {
  Views views;
  for (std::uint64_t i = 0; i < 40; ++i) {
    KeyedRandom random(1, i, 8);
    std::vector<Eigen::Vector3f> points;
    for (int label = 0; label < 16; ++label) {
      const Eigen::Vector3d at = 0.5 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
      const auto blinks = static_cast<int>(-5 * std::log(1 - random.uniform())) + 1;  // geometric, nearly
      for (int b = 0; b < blinks; ++b)
        points.push_back((at + 0.1 * Eigen::Vector3d(random.normal(), random.normal(), 2 * random.normal()))
                             .cast<float>());
    }
    View view;
    view.points.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t j = 0; j < points.size(); ++j) view.points.col(static_cast<Eigen::Index>(j)) = points[j];
    view.covariance.assign(points.size(), {0.01f, 0, 0, 0.01f, 0, 0.04f});
    views.view.push_back(view);
  }
  const Registration r = registered(views, 1);
  EXPECT_EQ(r.verdict, Verdict::none) << r.verdict_reason;
  EXPECT_EQ(accepted(r), 0);
}

TEST(Verdict, sitesAreAStructureAndSayByHowMuch) {
  const Scene scene(orbit_structure("none", 12, 3), 30, 0.8, 6, 4);
  const Registration r = registered(scene.views, 1);
  EXPECT_EQ(r.verdict, Verdict::found) << r.verdict_reason;
  EXPECT_GT(r.structure_gain, 3 * r.structure_gain_std);
  EXPECT_GT(accepted(r), 27);
}

TEST(Precision, statedIsWhatIsFound) {
  const Scene scene(orbit_structure("none", 12, 3), 40, 0.8, 6, 4);
  const Registration r = registered(scene.views, 1);
  // Residuals about the common motion that the median view has.
  std::vector<double> found, stated;
  for (std::size_t i = 0; i < scene.pose.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Matrix3d a = r.view[i].template_from_view.rotation * scene.pose[i].rotation.transpose();
      const Eigen::Matrix3d b = r.view[j].template_from_view.rotation * scene.pose[j].rotation.transpose();
      found.push_back(geodesic_angle(a, b));
      const double variance = r.view[i].covariance.topLeftCorner<3, 3>().trace() +
                              r.view[j].covariance.topLeftCorner<3, 3>().trace();
      stated.push_back(std::sqrt(variance) * 1.538 /
                       std::sqrt(3.0));  // median of the length of three normals
    }
  std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2), found.end());
  std::nth_element(stated.begin(), stated.begin() + static_cast<std::ptrdiff_t>(stated.size() / 2),
                   stated.end());
  const double ratio = stated[stated.size() / 2] / found[found.size() / 2];
  EXPECT_GT(ratio, 0.8);
  EXPECT_LT(ratio, 1.25);
}

}  // namespace
}  // namespace polar
