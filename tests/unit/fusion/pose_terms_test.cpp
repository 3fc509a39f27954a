#include "fusion/pose_terms.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fixture.hpp"
#include "fusion/view_likelihood.hpp"

namespace polar {
namespace {

using fixture::draw_view;
using fixture::random_mixture;
using fixture::random_pose;

double sum_of(const std::vector<Term>& terms, const Pose& pose) {
  double sum = 0;
  for (const Term& t : terms)
    sum += (t.root * ((t.moves ? pose * t.centre : pose.rotation * t.centre) - t.x)).squaredNorm();
  return sum;
}

// By definition, over all pairs, with the responsibilities at `held`.
double sum_over_pairs(const Mixture& m, const KernelLocalisations& view, const Pose& held, const Pose& pose) {
  double sum = 0;
  for (const kernel::Localisation& l : view) {
    Eigen::Matrix3d p;
    p << l.pxx, l.pxy, l.pxz, l.pxy, l.pyy, l.pyz, l.pxz, l.pyz, l.pzz;
    const Eigen::Vector3d x(l.x, l.y, l.z);
    const auto distance = [&](Eigen::Index k, const Pose& at) {
      const Eigen::Vector3d d = at * Eigen::Vector3d(m.centre.col(k).cast<double>()) - x;
      return d.dot(p * d);
    };
    double total = m.outlier_fraction * m.outlier_density;
    std::vector<double> density;
    for (Eigen::Index k = 0; k < m.size(); ++k) {
      density.push_back((1 - m.outlier_fraction) * double(m.weight[k]) * double(l.norm) *
                        std::exp(-0.5 * distance(k, held)));
      total += density.back();
    }
    for (Eigen::Index k = 0; k < m.size(); ++k)
      sum += density[static_cast<std::size_t>(k)] / total * distance(k, pose);
  }
  return sum;
}

TEST(PoseTerms, changeWithThePoseAsAllPairsDo) {
  const Mixture mixture = random_mixture(100, 5);
  const Pose held = random_pose(6).inverse();
  const View view = draw_view(mixture, random_pose(6), 50, 0.1f, 0.2f, 7);
  NoiseModel noise;
  noise.width = 0.1;  // several centres a localisation
  const KernelLocalisations localisations = kernel_localisations(view, Eigen::Vector3f::UnitZ(), noise, {});
  const BlockedMixture blocked(mixture);
  ViewFrame frame(blocked);
  const auto terms =
      terms_at(mixture, frame.at(held), blocked.background(), localisations, roots_of(localisations));
  EXPECT_GT(terms.size(), 3 * localisations.size());
  const double here = sum_of(terms, held), here_by_pairs = sum_over_pairs(mixture, localisations, held, held);
  for (int i = 0; i < 6; ++i) {
    const Pose pose = perturbed(held, 0.1 * Vector6::Unit(i));
    const double change = sum_of(terms, pose) - here;
    // Pairs below a responsibility of 1e-3 are left out.
    EXPECT_NEAR(change, sum_over_pairs(mixture, localisations, held, pose) - here_by_pairs,
                0.02 * std::abs(change) + 0.02)
        << i;
  }
}

TEST(PoseTerms, aSingleCentreHasNoSpread) {
  Mixture mixture = random_mixture(1, 5);
  const View view = draw_view(mixture, Pose{}, 20, 0.1f, 0.2f, 7);
  const KernelLocalisations localisations =
      kernel_localisations(view, Eigen::Vector3f::UnitZ(), NoiseModel{}, {});
  const BlockedMixture blocked(mixture);
  ViewFrame frame(blocked);
  const auto terms =
      terms_at(mixture, frame.at(Pose{}), blocked.background(), localisations, roots_of(localisations));
  EXPECT_LE(terms.size(), localisations.size());
  for (const Term& t : terms) EXPECT_TRUE(t.moves);
}

}  // namespace
}  // namespace polar
