#include "polar/latent/loss.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"
#include "polar/latent/density.hpp"

namespace polar {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

LatentOptions plain() {
  LatentOptions o;
  o.noise = "none";
  return o;
}

Pose some_pose() { return {so3_exp({0.4, -1.1, 0.7}), {0.03, -0.05, 0.02}}; }

Eigen::VectorXf some_z(const Autoencoder& model) { return model.encode(fixture::three_bars(300, 5)).latent; }

// One view of the decoded template itself, in `pose`, units of the autoencoder.
LatentView ideal_view(const Autoencoder& model, const Eigen::Matrix3Xf& points, const Pose& pose,
                      const LatentOptions& options) {
  Views views;
  Eigen::Matrix3Xf there = pose.rotation.cast<float>() * points;
  there.colwise() += pose.translation.cast<float>();
  views.view.push_back(fixture::view_of(there, 0.05f, 0.15f));
  LatentViews latent = latent_views(views, model, options);
  LatentView view = latent.view[0];  // undo the scale: the template is in units of the autoencoder already
  const auto s = static_cast<float>(1 / latent.scale);
  view.points *= s, view.noise *= s;
  for (auto& root : view.spread) root *= s;
  view.encoded = model.encode(view.points).latent;
  return view;
}

TEST(LatentLoss, vanishesAtTheTruthWithoutNoiseAndNowhereNear) {
  const auto model = fixture::shipped();
  LatentOptions options = plain();
  options.localisations = 2000;
  const Eigen::Matrix3Xf points = model->decode(some_z(*model));
  const LatentView view = ideal_view(*model, points, some_pose(), options);
  const double at_truth = view_loss(*model, view, points, some_pose(), Derive::nothing).loss;
  Vector6d off;
  off << 0.1, 0, 0, 0, 0, 0;
  const double beside = view_loss(*model, view, points, stepped(some_pose(), off), Derive::nothing).loss;
  EXPECT_LT(at_truth, 1e-6);
  EXPECT_GT(beside, 1e-2);
}

TEST(LatentLoss, anEmptyViewCostsNothing) {
  const fixture::WavyAutoencoder model;
  const LossTerm term = view_loss(model, {}, model.decode(some_z(model)), {}, Derive::pose_and_template);
  EXPECT_EQ(term.loss, 0);
  EXPECT_EQ(term.template_gradient.norm(), 0);
}

TEST(LatentLoss, drawsAsManyPointsAsRemainAfterBothMasks) {
  const fixture::WavyAutoencoder model;
  LatentOptions options;
  options.visibility = 0.5;
  options.outlier_fraction = 0.2;
  Views views;
  views.view.push_back(fixture::view_of(fixture::three_bars(100, 1), 0.02f, 0.05f));
  const LatentViews latent = latent_views(views, model, options);
  EXPECT_EQ(latent.view[0].source.size(), 160u);  // (1 - 0.2) x 100 / 0.5
  EXPECT_EQ(simulated_view(latent.view[0], model.decode(some_z(model)), {}).cols(), 80);
  options.matched_counts = false;
  EXPECT_EQ(latent_views(views, model, options).view[0].source.size(), 40u);  // every decoded point
}

TEST(LatentLoss, noiseHasTheCovarianceOfEveryLocalisation) {
  const fixture::WavyAutoencoder model;
  LatentOptions options;
  options.localisations = 100000;
  Views views;
  View view = fixture::view_of(fixture::three_bars(60000, 1), 0.02f, 0.1f);
  for (std::size_t j = 0; j < view.covariance.size(); ++j)
    view.covariance[j] = {0.04f, 0.01f, 0.005f, 0.03f, -0.01f, 0.05f};
  views.view.push_back(view);
  const LatentViews latent = latent_views(views, model, options);
  const Eigen::Matrix3d covariance =
      (latent.view[0].noise * latent.view[0].noise.transpose()).cast<double>() /
      (60000 * latent.scale * latent.scale);
  EXPECT_NEAR(covariance(0, 0), 0.04, 1e-3);
  EXPECT_NEAR(covariance(1, 1), 0.03, 1e-3);
  EXPECT_NEAR(covariance(2, 2), 0.05, 1e-3);
  EXPECT_NEAR(covariance(0, 1), 0.01, 1e-3);
  EXPECT_NEAR(covariance(0, 2), 0.005, 1e-3);
  EXPECT_NEAR(covariance(1, 2), -0.01, 1e-3);
}

// Noise, a crop and outliers at once: every derivative against central differences.
class Derivatives : public ::testing::TestWithParam<bool> {};

TEST_P(Derivatives, matchCentralDifferences) {
  constexpr double kStep = 1e-3, kTolerance = 5e-3;  // single precision: 1e-7 / kStep, and the curvature
  const fixture::WavyAutoencoder model;
  LatentOptions options;
  const Eigen::VectorXf z = some_z(model);
  const Eigen::Matrix3Xf points = model.decode(z);
  LatentView view = ideal_view(model, points, some_pose(), options);
  if (GetParam()) set_degradation(view, 0, model.decoded_points(), 0.75, 0.2, options);
  Vector6d off;
  off << 0.15, -0.1, 0.05, 0.04, 0.02, -0.03;
  const Pose pose = stepped(some_pose(), off);
  const LossTerm term = view_loss(model, view, points, pose, Derive::pose_and_template);
  const auto loss = [&](const Eigen::Matrix3Xf& p, const Pose& at) {
    return view_loss(model, view, p, at, Derive::nothing).loss;
  };
  const Vector6d gradient = 2 * (term.jacobian.transpose() * term.residual).cast<double>();
  for (int k = 0; k < 6; ++k) {
    const Vector6d e = Vector6d::Unit(k) * kStep;
    const double difference =
        (loss(points, stepped(pose, e)) - loss(points, stepped(pose, -e))) / (2 * kStep);
    EXPECT_NEAR(gradient[k], difference, kTolerance * gradient.norm()) << k;
  }
  const double size = static_cast<double>(term.template_gradient.norm());
  for (Eigen::Index p = 0; p < points.cols(); p += 3)
    for (Eigen::Index a = 0; a < 3; ++a) {
      Eigen::Matrix3Xf up = points, down = points;
      up(a, p) += static_cast<float>(kStep), down(a, p) -= static_cast<float>(kStep);
      const double difference = (loss(up, pose) - loss(down, pose)) / (2 * kStep);
      EXPECT_NEAR(static_cast<double>(term.template_gradient(a, p)), difference, kTolerance * size) << p << a;
    }
  const Eigen::VectorXd in_z = model.decode_gradient(z, term.template_gradient).cast<double>();
  for (Eigen::Index c = 0; c < z.size(); c += 5) {
    Eigen::VectorXf up = z, down = z;
    up[c] += static_cast<float>(kStep), down[c] -= static_cast<float>(kStep);
    const double difference = (loss(model.decode(up), pose) - loss(model.decode(down), pose)) / (2 * kStep);
    EXPECT_NEAR(in_z[c], difference, kTolerance * in_z.norm()) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithMasks, Derivatives, ::testing::Bool());

TEST(LatentLoss, aMaskForgivesTheHiddenPartAndNothingElse) {
  const auto model = fixture::shipped();
  LatentOptions options = plain();
  options.localisations = 2000;
  const Eigen::Matrix3Xf points = model->decode(some_z(*model));
  LatentView view = ideal_view(*model, points, some_pose(), options);
  std::vector<std::pair<float, Eigen::Index>> along;
  for (Eigen::Index j = 0; j < view.points.cols(); ++j) along.emplace_back(view.points(0, j), j);
  std::sort(along.begin(), along.end());
  const Eigen::Index seen = std::lround(0.7 * static_cast<double>(along.size()));
  Eigen::Matrix3Xf part(3, seen);
  for (Eigen::Index k = 0; k < seen; ++k)
    part.col(k) = view.points.col(along[static_cast<std::size_t>(k)].second);
  view.points = part;
  view.spread.resize(static_cast<std::size_t>(seen));
  view.encoded = model->encode(part).latent;
  const auto loss = [&](double visibility) {
    set_degradation(view, 0, model->decoded_points(), visibility, 0, options);
    return view_loss(*model, view, points, some_pose(), Derive::nothing).loss;
  };
  EXPECT_LT(loss(0.7), 0.1 * loss(1));
}

TEST(DensitySpread, matchesCentralDifferencesAndFallsAlongItsGradient) {
  constexpr double kStep = 1e-3, kRadius = 0.4;
  Eigen::Matrix3Xf points = fixture::three_bars(120, 3), gradient;
  const double here = density_spread(points, kRadius, &gradient);
  for (Eigen::Index p = 0; p < points.cols(); p += 7)
    for (Eigen::Index a = 0; a < 3; ++a) {
      Eigen::Matrix3Xf up = points, down = points;
      up(a, p) += static_cast<float>(kStep), down(a, p) -= static_cast<float>(kStep);
      const double difference =
          (density_spread(up, kRadius, nullptr) - density_spread(down, kRadius, nullptr)) / (2 * kStep);
      EXPECT_NEAR(static_cast<double>(gradient(a, p)), difference,
                  2e-2 * static_cast<double>(gradient.norm()));
    }
  points -= 0.05f / gradient.norm() * gradient;
  EXPECT_LT(density_spread(points, kRadius, nullptr), here);
}

}  // namespace
}  // namespace polar
