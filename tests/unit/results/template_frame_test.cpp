#include "polar/results/template_frame.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/simulation/structure.hpp"

namespace polar {
namespace {

constexpr double kTolerance = 1e-9;  // of order 1 numbers after a handful of products

Registration registration_of(const Eigen::Matrix3Xd& sites) {
  Registration r;
  r.fused.centre = sites;
  r.fused.weight = Eigen::VectorXd::LinSpaced(sites.cols(), 1, 2);  // uneven, so that no side is like another
  r.fused.weight /= r.fused.weight.sum();
  r.view.resize(2);
  r.view[1].template_from_view = {so3_exp({0.3, -1, 0.2}), {0.1, 0.2, 0.3}};
  r.view[1].covariance.diagonal() << 1, 2, 3, 4, 5, 6;
  return r;
}

TEST(TemplateFrame, ARingLiesInThePlaneAndARodStandsUp) {
  KeyedRandom random(3, 0, 1);
  for (const char* kind : {"ring", "centriole"}) {
    StructureOptions options;
    options.kind = kind;
    const Eigen::Matrix3Xd sites = make_structure(options).site_nm / 100;
    for (int trial = 0; trial < 5; ++trial) {
      const Eigen::Matrix3d turn = random.rotation();
      Registration r = registration_of((turn * sites).colwise() + Eigen::Vector3d(1, 2, 3));
      move_template(r, own_frame_from_template(r, false));
      EXPECT_LT((r.fused.centre * r.fused.weight).norm(), kTolerance);
      const double height = r.fused.centre.row(2).maxCoeff() - r.fused.centre.row(2).minCoeff();
      EXPECT_NEAR(height, sites.row(2).maxCoeff() - sites.row(2).minCoeff(), 0.2) << kind;
    }
  }
}

TEST(TemplateFrame, DoesNotDependOnHowTheTemplateWasTurned) {
  KeyedRandom random(4, 0, 1);
  Eigen::Matrix3Xd sites(3, 12);
  for (Eigen::Index k = 0; k < sites.cols(); ++k)
    sites.col(k) << 3 * random.normal(), 2 * random.normal(), random.normal();
  Registration first = registration_of(sites);
  move_template(first, own_frame_from_template(first, false));
  for (int trial = 0; trial < 10; ++trial) {
    Registration r = registration_of((random.rotation() * sites).colwise() + Eigen::Vector3d(1, -2, 0.5));
    move_template(r, own_frame_from_template(r, false));
    EXPECT_LT((r.fused.centre - first.fused.centre).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(TemplateFrame, PlanarTemplatesStayInThePlane) {
  StructureOptions options;
  options.kind = "ring";
  Registration r = registration_of(so3_exp({0, 0, 0.4}) * make_structure(options).site_nm / 50);
  const Pose p = own_frame_from_template(r, true);
  EXPECT_NEAR(p.rotation(2, 2), 1, kTolerance);
  EXPECT_NEAR(p.translation.z(), 0, kTolerance);
}

TEST(TemplateFrame, AKnownSymmetryGivesIt) {
  Registration r = registration_of(Eigen::Matrix3Xd::Random(3, 5));
  r.symmetry.emplace();
  r.symmetry->group = "C8";
  r.symmetry->canonical_from_template = {so3_exp({0.5, 0.2, -1}), {1, 2, 3}};
  r.symmetry->unit = r.fused.centre;
  const Eigen::Matrix3Xd canonical =
      (r.symmetry->canonical_from_template.rotation * r.fused.centre).colwise() + Eigen::Vector3d(1, 2, 3);
  move_template(r, own_frame_from_template(r, false));
  EXPECT_LT((r.fused.centre - canonical).norm(), kTolerance);
  EXPECT_LT((r.symmetry->unit - canonical).norm(), kTolerance);
  EXPECT_LT(geodesic_angle(r.symmetry->canonical_from_template.rotation, Eigen::Matrix3d::Identity()), 1e-7);
  EXPECT_LT(r.symmetry->canonical_from_template.translation.norm(), kTolerance);
}

// A pose and its error, moved, are the moved pose with the moved error: exp(w) x + v before and after.
TEST(TemplateFrame, CovariancesMoveWithTheFrame) {
  const Pose g{so3_exp({0.4, 1.1, -0.3}), {2, -1, 0.5}};
  Registration r = registration_of(Eigen::Matrix3Xd::Random(3, 5));
  const Pose before = r.view[1].template_from_view;
  const Eigen::Matrix<double, 6, 6> covariance = r.view[1].covariance;
  move_template(r, g);
  EXPECT_LT(
      (r.view[1].template_from_view * Eigen::Vector3d(1, 2, 3) - g * (before * Eigen::Vector3d(1, 2, 3)))
          .norm(),
      kTolerance);
  Eigen::Matrix<double, 6, 6> jacobian;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    error[i] = kStep;
    const Pose wrong = g * Pose{so3_exp(error.head<3>()), error.tail<3>()} * g.inverse();
    jacobian.col(i) << so3_log(wrong.rotation) / kStep, wrong.translation / kStep;
  }
  EXPECT_LT((r.view[1].covariance - jacobian * covariance * jacobian.transpose()).norm(), 1e-4);
}

}  // namespace
}  // namespace polar
