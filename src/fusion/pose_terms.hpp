// Least squares terms of a view's pose for given responsibilities.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "localisations.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

// A term |root (turn centre + shift - x)|^2. The pairs of one localisation with its centres mu_k sum up to
// four: sum r_k |root (R mu_k + t - x)|^2 = r |root (R mu + t - x)|^2 + sum_a |root R l_a|^2 with r = sum
// r_k, the mean centre mu and the columns l_a of a root of the spread sum r_k (mu_k - mu) (mu_k - mu)^T.
struct Term {
  Eigen::Vector3d centre;  // template frame: mu, or l_a
  Eigen::Vector3d x;       // localisation, frame of the view
  Eigen::Matrix3d root;    // root^T root = r C^-1, or C^-1
  bool moves;              // false: l_a, which a shift leaves alone
};

/// C^(-1/2) of every localisation: root^T root = C^-1.
std::vector<Eigen::Matrix3d> roots_of(const KernelLocalisations& view);

/// The terms of all localisations with the responsibilities of the centres at a pose.
std::vector<Term> terms_at(const Mixture& mixture, const kernel::Centres& centres, float background,
                           const KernelLocalisations& view, const std::vector<Eigen::Matrix3d>& roots);

}  // namespace polar
