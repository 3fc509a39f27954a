#include "latent/descent.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"
#include "polar/core/constants.hpp"
#include "polar/latent/template.hpp"

namespace polar {
namespace {

// A view of the decoded template, without noise, turned by nothing: the answer is the identity.
struct Ideal {
  std::unique_ptr<Autoencoder> model = fixture::shipped();
  LatentOptions options;
  Eigen::Matrix3Xf points;
  LatentView view;

  explicit Ideal(const std::string& optimizer) {
    options.noise = "none";
    options.optimizer = optimizer;
    points = model->decode(model->encode(fixture::three_bars(300, 5)).latent);
    view.points = points;
    view.spread.resize(static_cast<std::size_t>(points.cols()), Eigen::Matrix3f::Zero());
    view.encoded = model->encode(points).latent;
    set_degradation(view, 0, model->decoded_points(), 1, 0, options);
  }
};

double angle_deg(const Pose& pose) { return so3_log(pose.rotation).norm() * kDegreesPerRadian; }

TEST(DescendPose, levenbergMarquardtComesBackInAFewEvaluations) {
  const Ideal ideal("levenberg_marquardt");
  const Pose start{so3_exp({0.2, -0.15, 0.1}), {0.05, -0.03, 0.02}};
  const DescendedPose end =
      descend_pose(*ideal.model, ideal.view, false, ideal.points, start, ideal.options, 15);
  EXPECT_LE(end.evaluations, 15);
  EXPECT_LT(angle_deg(end.view_from_template), 0.5);
  EXPECT_LT(end.view_from_template.translation.norm(), 0.01);
}

TEST(DescendPose, adamwComesBackToo) {
  const Ideal ideal("adamw");
  const Pose start{so3_exp({0.1, -0.05, 0.05}), {0.02, -0.03, 0.02}};
  const DescendedPose end =
      descend_pose(*ideal.model, ideal.view, false, ideal.points, start, ideal.options, 120);
  EXPECT_LT(angle_deg(end.view_from_template), 1);
}

TEST(DescendPose, planarMotionsStayInThePlane) {
  const Ideal ideal("levenberg_marquardt");
  const Pose start{so3_exp({0, 0, 0.2}), {0.05, -0.03, 0}};
  const Pose end =
      descend_pose(*ideal.model, ideal.view, true, ideal.points, start, ideal.options, 15).view_from_template;
  EXPECT_LT(angle_deg(end), 0.5);
  EXPECT_EQ(end.rotation(2, 2), 1);
  EXPECT_EQ(end.translation.z(), 0);
}

TEST(Plateau, lowersTheRateAndEnds) {
  Plateau plateau(1, 0.1, 2, 4, 0);
  EXPECT_TRUE(plateau.improved(5));
  EXPECT_FALSE(plateau.improved(6));
  EXPECT_FALSE(plateau.improved(6));
  EXPECT_DOUBLE_EQ(plateau.rate(), 0.1);
  EXPECT_TRUE(plateau.improved(4));
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(plateau.over());
    plateau.improved(4.5);
  }
  EXPECT_TRUE(plateau.over());
}

TEST(AdamW, firstStepHasTheLengthOfTheRate) {
  AdamW adam(2);
  const Eigen::VectorXd step = adam.step(Eigen::Vector2d(3, -0.01), 0.1);
  EXPECT_NEAR(step[0], -0.1, 1e-6);
  EXPECT_NEAR(step[1], 0.1, 1e-6);
}

}  // namespace
}  // namespace polar
