#include "relaxation.hpp"

#include <cmath>

#include "label_spots.hpp"

namespace polar {

namespace {

// Every view's labels under probabilities that other views gave, with the group and without.
Comparison told_apart(const LabelSpots& spots, const Problem& problem, const EngineOptions& options) {
  const auto folds = static_cast<std::size_t>(options.anneal.folds);
  Evidence with(problem.size(), NAN), without = with;
  for (std::size_t f = 0; f < folds; ++f) {
    std::vector<int> others;
    for (const int v : problem.all)
      if (static_cast<std::size_t>(v) % folds != f) others.push_back(v);
    if (others.empty()) continue;
    const LabelSpots::Probabilities p = spots.fitted(others, options.symmetry, problem.seed);
    for (std::size_t i = f; i < problem.size(); i += folds) {
      with[i] = spots.log_likelihood(spots.even(), i) / spots.labels(i);
      without[i] = spots.log_likelihood(p, i) / spots.labels(i);
    }
  }
  return compare(with, without);
}

}  // namespace

Relaxation relaxed(const Problem& problem, const EngineOptions& options, const Fit& symmetric) {
  const LabelSpots spots(problem, symmetric);
  Relaxation out{symmetric, told_apart(spots, problem, options)};
  const LabelSpots::Probabilities p = spots.fitted(problem.all, options.symmetry, problem.seed);
  out.fit.group.clear();
  for (std::size_t i = 0; i < problem.size(); ++i)
    out.fit.pose[i] = Pose{symmetric.group[spots.element(p, i)], Eigen::Vector3d::Zero()} * symmetric.pose[i];
  Eigen::VectorXf& weight = out.fit.mixture.weight;
  for (Eigen::Index k = 0; k < weight.size(); ++k) weight[k] *= static_cast<float>(spots.factor(p, k));
  weight /= weight.sum();
  return out;
}

}  // namespace polar
