#include "polar/latent/latent_registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fixture.hpp"
#include "latent/mask.hpp"
#include "latent/medoid.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"

namespace polar {
namespace {

LatentOptions small() {
  LatentOptions o;
  o.localisations = 600;
  o.rotations = 600;
  o.basins = 4;
  return o;
}

LatentRegistration registered(const Views& views, const LatentOptions& options) {
  static const auto model = fixture::shipped();
  Progress silent;
  return register_latent(views, *model, options, silent);
}

// Angles between all pairs' relative rotations and the true ones, degrees, ascending.
std::vector<double> pair_errors(const LatentRegistration& r, const std::vector<Pose>& view_from_structure) {
  std::vector<double> error;
  const std::size_t n = view_from_structure.size();
  const auto motion = [&](std::size_t i) -> Eigen::Matrix3d {
    return r.view[i].template_from_view.rotation * view_from_structure[i].rotation;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      error.push_back(geodesic_angle(motion(i), motion(j)) * kDegreesPerRadian);
  std::sort(error.begin(), error.end());
  return error;
}

double recall(const std::vector<double>& error, double deg) {
  return static_cast<double>(std::lower_bound(error.begin(), error.end(), deg) - error.begin()) /
         static_cast<double>(error.size());
}

TEST(RegisterLatent, findsAllViewsOfAnAsymmetricShape) {
  const fixture::Posed p = fixture::posed_views(20, 600, 0.02f, 0.06f, 3);
  const LatentRegistration r = registered(p.views, small());
  const std::vector<double> error = pair_errors(r, p.view_from_structure);
  EXPECT_GE(recall(error, 10), 0.9);
  EXPECT_LT(error[error.size() / 2], 5);
  EXPECT_GE(r.loops, 1);
  EXPECT_EQ(r.template_points.cols(), 1024);
  EXPECT_NE(r.stopped_because, "never ran");
  for (const LatentPose& v : r.view) EXPECT_GT(v.covariance.diagonal().minCoeff(), 0);
}

TEST(RegisterLatent, findsThemWithADecodedTemplateToo) {
  const fixture::Posed p = fixture::posed_views(12, 300, 0.02f, 0.06f, 3);
  LatentOptions options = small();
  options.template_kind = "decoded";
  options.localisations = 300;
  const std::vector<double> error = pair_errors(registered(p.views, options), p.view_from_structure);
  EXPECT_GE(recall(error, 10), 0.8);
}

TEST(RegisterLatent, decodesItsTemplateWhereOutliersAreExpected) {
  const fixture::Posed p = fixture::posed_views(6, 200, 0.02f, 0.06f, 4);
  LatentOptions options = small();
  options.localisations = 200;
  options.most_loops = 1;
  const auto template_points = [&](const char* kind, double outliers) {
    options.template_kind = kind;
    options.outlier_fraction = outliers;
    return registered(p.views, options).template_points;
  };
  EXPECT_EQ(template_points("fused", 0.3), template_points("decoded", 0.3));
  EXPECT_NE(template_points("fused", 0), template_points("decoded", 0));
}

TEST(RegisterLatent, turnsWithItsInput) {
  fixture::Posed p = fixture::posed_views(12, 600, 0.02f, 0.02f, 5);
  const LatentRegistration before = registered(p.views, small());
  const Eigen::Matrix3d turn = so3_exp({0.9, -0.4, 1.3});
  for (std::size_t i = 0; i < p.views.view.size(); ++i) {
    p.views.view[i].points = (turn.cast<float>() * p.views.view[i].points).eval();
    p.view_from_structure[i].rotation = turn * before.view[i].template_from_view.rotation.transpose();
  }
  const std::vector<double> moved = pair_errors(registered(p.views, small()), p.view_from_structure);
  EXPECT_LT(moved[moved.size() / 2], 4);
  EXPECT_GE(recall(moved, 10), 0.8);
}

TEST(RegisterLatent, staysInThePlaneOfPlanarData) {
  const fixture::Posed p = fixture::posed_views(10, 300, 0.02f, 0, 6, true);
  const LatentRegistration r = registered(p.views, [] {
    LatentOptions o = small();
    o.rotations = 0;
    return o;
  }());
  for (const LatentPose& v : r.view) {
    EXPECT_NEAR(v.template_from_view.rotation(2, 2), 1, 1e-6);
    EXPECT_NEAR(v.template_from_view.translation.z(), 0, 1e-6);
  }
  EXPECT_LT(r.template_points.row(2).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_GE(recall(pair_errors(r, p.view_from_structure), 10), 0.8);
}

TEST(RegisterLatent, givesTheSameBitsForAnyNumberOfThreads) {
  const fixture::Posed p = fixture::posed_views(7, 150, 0.03f, 0.06f, 7);
  LatentOptions options = small();
  options.rotations = 300;
  options.most_loops = 1;
  options.visibility = 0;  // estimated
  LatentRegistration one, two;
  {
    const ThreadLimit limit(1);
    ASSERT_EQ(thread_limit(), 1);
    one = registered(p.views, options);
  }
  {
    const ThreadLimit limit(2);
    two = registered(p.views, options);
  }
  EXPECT_EQ(one.loss, two.loss);
  for (std::size_t i = 0; i < one.view.size(); ++i) {
    EXPECT_EQ(one.view[i].template_from_view.rotation, two.view[i].template_from_view.rotation);
    EXPECT_EQ(one.view[i].template_from_view.translation, two.view[i].template_from_view.translation);
  }
  EXPECT_EQ(one.template_points, two.template_points);
}

TEST(RegisterLatent, leavesEmptyViewsAlone) {
  fixture::Posed p = fixture::posed_views(4, 100, 0.02f, 0.02f, 8);
  p.views.view.insert(p.views.view.begin() + 1, View{Eigen::Matrix3Xf(3, 0), {}});
  LatentOptions options = small();
  options.rotations = 200;
  options.most_loops = 1;
  const LatentRegistration r = registered(p.views, options);
  EXPECT_EQ(r.view[1].n_used, 0);
  EXPECT_TRUE(r.view[1].template_from_view.rotation.isIdentity());
  Views none;
  none.view.resize(3, View{Eigen::Matrix3Xf(3, 0), {}});
  EXPECT_EQ(registered(none, options).stopped_because, "no view has localisations");
}

TEST(Medoids, beginWithTheViewOfLeastSummedDistance) {
  LatentViews views;
  for (const float x : {0.0f, 1.0f, 1.2f, 1.4f, 9.0f}) {
    LatentView v;
    v.points = Eigen::Matrix3Xf::Zero(3, 1);
    v.encoded = Eigen::VectorXf::Constant(1, x);
    views.view.push_back(v);
  }
  EXPECT_EQ(medoids(views, 1), std::vector<int>{2});
  const std::vector<int> two = medoids(views, 2);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_TRUE(two[1] == 1 || two[1] == 3);  // never the stray ones
}

TEST(NearestShare, keepsTheNearestAndAtLeastOne) {
  Eigen::VectorXf distance(5);
  distance << 3, 1, 2, 1, 9;
  EXPECT_EQ(nearest_share(distance, 0.6), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(nearest_share(distance, 0.0), (std::vector<int>{1}));
  EXPECT_EQ(nearest_share(distance, 1.0).size(), 5u);
}

TEST(LatentOptions, namesEveryFault) {
  LatentOptions o;
  EXPECT_TRUE(violations(o).empty());
  o.visibility = 1.2;
  o.noise = "pink";
  o.outlier_fraction = -0.5;
  o.optimizer = "sgd";
  EXPECT_EQ(violations(o).size(), 4u);
}

}  // namespace
}  // namespace polar
