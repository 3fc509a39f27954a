#include "fusion/view_likelihood.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"
#include "polar/core/isa.hpp"

namespace polar {
namespace {

using fixture::draw_view;
using fixture::random_mixture;
using fixture::random_pose;

struct Case {
  explicit Case(bool is_planar)
      : planar(is_planar),
        mixture(random_mixture(100, 5, planar)),
        truth(random_pose(6, planar)),
        view(draw_view(mixture, truth, 300, 0.05f, 0.12f, 7, planar)),
        blocked(mixture) {
    noise.width = 0.03;
    noise.planar = planar;
    localisations = kernel_localisations(view, Eigen::Vector3f::UnitZ(), noise, {});
  }
  bool planar;
  Mixture mixture;
  Pose truth;
  View view;
  NoiseModel noise;
  BlockedMixture blocked;
  KernelLocalisations localisations;
};

// The definition, in double, without cut-off, blocks or vectors.
double by_definition(const Case& c, const Pose& view_from_template) {
  double total = 0;
  for (std::size_t j = 0; j < c.view.covariance.size(); ++j) {
    const Symmetric3 e = effective_covariance(c.view.covariance[j], Eigen::Vector3f::UnitZ(), c.noise);
    Eigen::Matrix3d s;
    s << e[0], e[1], e[2], e[1], e[3], e[4], e[2], e[4], e[5];
    const int d = c.planar ? 2 : 3;
    double p = c.mixture.outlier_fraction * c.mixture.outlier_density;
    for (Eigen::Index k = 0; k < c.mixture.size(); ++k) {
      const Eigen::Vector3d diff =
          c.view.points.col(static_cast<Eigen::Index>(j)).cast<double>() -
          view_from_template * Eigen::Vector3d(c.mixture.centre.col(k).cast<double>());
      const Eigen::MatrixXd cov = s.topLeftCorner(d, d);
      const Eigen::VectorXd x = diff.head(d);
      p += (1 - c.mixture.outlier_fraction) * double(c.mixture.weight[k]) *
           std::exp(-0.5 * x.dot(cov.ldlt().solve(x))) /
           std::sqrt(std::pow(6.283185307179586, d) * cov.determinant());
    }
    total += std::log(p);
  }
  return total;
}

class ViewLikelihood : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, ViewLikelihood, ::testing::Values(false, true),
                         [](const auto& dimension) { return dimension.param ? "planar" : "spatial"; });

TEST_P(ViewLikelihood, equalsItsDefinition) {
  Case c(GetParam());
  ViewFrame frame(c.blocked);
  const Pose pose = c.truth.inverse();
  // The cut-off at 4 standard deviations leaves out less than 1e-3 of a density.
  EXPECT_NEAR(log_likelihood(frame, c.localisations, pose, c.blocked.background()), by_definition(c, pose),
              0.3);
}

TEST_P(ViewLikelihood, gradientMatchesCentralDifferences) {
  Case c(GetParam());
  ViewFrame frame(c.blocked);
  Vector6 off = Vector6::Zero();
  off << 0.02, -0.03, 0.04, 0.02, 0.01, -0.02;
  if (c.planar) off[0] = off[1] = off[5] = 0;
  const Pose pose = perturbed(c.truth.inverse(), off);
  const PoseDerivatives d = pose_derivatives(frame, c.localisations, pose, c.blocked.background());
  constexpr double kStep = 1e-3;  // large enough for single precision sums
  for (int i = 0; i < 6; ++i) {
    if (c.planar && (i == 0 || i == 1 || i == 5)) continue;
    const auto at = [&](double s) {
      return log_likelihood(frame, c.localisations, perturbed(pose, s * Vector6::Unit(i)),
                            c.blocked.background());
    };
    const double numeric = (at(kStep) - at(-kStep)) / (2 * kStep);
    EXPECT_NEAR(d.gradient[i], numeric, 0.02 * std::abs(numeric) + 1.0) << i;
  }
}

TEST_P(ViewLikelihood, refinementFindsTheTruthFromEightDegreesOff) {
  Case c(GetParam());
  ViewFrame frame(c.blocked);
  Vector6 off = Vector6::Zero();
  off << 0.08, -0.08, 0.08, 0.05, 0.05, -0.05;
  if (c.planar) off[0] = off[1] = off[5] = 0;
  const RefinedPose r = refine_pose(frame, c.localisations, perturbed(c.truth.inverse(), off),
                                    c.blocked.background(), c.planar, 40);
  EXPECT_LT(geodesic_angle(r.view_from_template.rotation, c.truth.inverse().rotation) * 57.3, 1.5);
  EXPECT_LT((r.view_from_template.translation - c.truth.inverse().translation).norm(), 0.03);
  EXPECT_GE(r.log_likelihood,
            log_likelihood(frame, c.localisations, c.truth.inverse(), c.blocked.background()) - 1e-3);
}

TEST(ViewLikelihoodProperty, turningTheViewWithItsCovariancesTurnsThePoseAlong) {
  Case c(false);
  const Eigen::Matrix3d q = so3_exp({0.7, -0.4, 1.1});
  View turned = c.view;
  turned.points = q.cast<float>() * c.view.points;
  for (Symmetric3& s : turned.covariance) {
    Eigen::Matrix3d m;
    m << double(s[0]), double(s[1]), double(s[2]), double(s[1]), double(s[3]), double(s[4]), double(s[2]),
        double(s[4]), double(s[5]);
    m = q * m * q.transpose();
    s = {float(m(0, 0)), float(m(0, 1)), float(m(0, 2)), float(m(1, 1)), float(m(1, 2)), float(m(2, 2))};
  }
  const Eigen::Vector3f axis = uncertainty_axis(turned, false);
  EXPECT_NEAR(std::abs(axis.cast<double>().dot(q.col(2))), 1, 1e-4);
  const KernelLocalisations localisations = kernel_localisations(turned, axis, c.noise, {});
  ViewFrame frame(c.blocked);
  const Pose turned_pose = Pose{q, Eigen::Vector3d::Zero()} * c.truth.inverse();
  EXPECT_NEAR(log_likelihood(frame, localisations, turned_pose, c.blocked.background()),
              log_likelihood(frame, c.localisations, c.truth.inverse(), c.blocked.background()), 0.05);
}

TEST(MixtureKernels, everyInstructionSetAgreesWithThePortableOne) {
  Case c(false);
  ViewFrame frame(c.blocked);
  const Pose pose = c.truth.inverse();
  limit_isa(Isa::portable);
  const PoseDerivatives reference = pose_derivatives(frame, c.localisations, pose, c.blocked.background());
  for (const Isa isa : {Isa::avx2, Isa::avx512}) {
    if (detected_isa() < isa) continue;
    limit_isa(isa);
    const PoseDerivatives d = pose_derivatives(frame, c.localisations, pose, c.blocked.background());
    // Single precision, other orders of summation and fused products.
    EXPECT_NEAR(d.log_likelihood, reference.log_likelihood, 1e-4 * std::abs(reference.log_likelihood))
        << name(isa);
    EXPECT_LT((d.gradient - reference.gradient).norm(), 1e-3 * (1 + reference.fisher.trace())) << name(isa);
  }
  limit_isa(Isa::avx512);
}

}  // namespace
}  // namespace polar
