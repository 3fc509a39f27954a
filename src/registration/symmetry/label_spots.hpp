// Views of one structure, each turned by a hidden element of a group: with which probability its spots carry
// a label. Expectation-maximisation over the elements. That a spot is dark says as much as that another is
// not, which a density forgets.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "../refine/refine.hpp"
#include "polar/registration/engine_options.hpp"

namespace polar {

class LabelSpots {
 public:
  using Probabilities = std::vector<double>;  // of a label, one a spot

  /// Spots are the centres of `symmetric` merged within twice the typical uncertainty; what a view shows is
  /// counted in bursts, each as one localisation: blinks of one label say the same.
  LabelSpots(const Problem& problem, const Fit& symmetric);

  /// Of every spot alike over the group.
  const Probabilities& even() const { return even_; }
  /// The likeliest for the views `which` that is reached from what single ones show.
  Probabilities fitted(const std::vector<int>& which, const SymmetryOptions& options,
                       std::uint64_t seed) const;

  /// ln of the probability of what a view shows, each element as likely as another; NAN: it shows nothing.
  double log_likelihood(const Probabilities& probability, std::size_t view) const;
  /// Spots that a view shows, at least 1.
  double labels(std::size_t view) const;
  /// The likeliest element of a view.
  std::size_t element(const Probabilities& probability, std::size_t view) const;
  /// What the weight of a centre of the template is multiplied with.
  double factor(const Probabilities& probability, Eigen::Index centre) const;

 private:
  Probabilities stepped(const Probabilities& now, const std::vector<int>& which,
                        const SymmetryOptions& options, double& reached) const;
  std::vector<double> posterior(const Probabilities& probability, const std::vector<double>& lit,
                                double& total) const;

  std::vector<std::size_t> spot_of_;             // of every centre
  std::vector<std::vector<std::size_t>> image_;  // of every element: where it turns a spot to
  std::vector<std::vector<double>> lit_;  // of every view and spot, 0 dark to 1; none: it shows nothing
  Probabilities even_;
};

}  // namespace polar
