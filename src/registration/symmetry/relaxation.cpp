#include "relaxation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "polar/core/covariance3.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/occupancy.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kReferenceStage = 45;
constexpr double kLeast = 0.01;     // probability of any number of labels at any spot
constexpr std::size_t kLevels = 2;  // labels of a spot that are told apart: none or some

Eigen::Index nearest(const Eigen::Matrix3Xf& points, const Eigen::Vector3f& x) {
  Eigen::Index at = 0;
  (points.colwise() - x).colwise().squaredNorm().minCoeff(&at);
  return at;
}

// Root mean square uncertainty along one axis.
double typical_sigma(const Problem& problem) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < problem.size(); ++i)
    for (const std::uint32_t j : problem.sampled[i]) {
      const Symmetric3& c = problem.views.view[i].covariance[j];
      sum += static_cast<double>(problem.planar() ? c[0] + c[3] : c[0] + c[3] + c[5]);
      count += problem.planar() ? 2 : 3;
    }
  return std::sqrt(sum / std::max(1.0, count)) * problem.noise.lateral_factor;
}

// The bursts of every view, each as one localisation: blinks of one label say the same.
Views merged_bursts(const Problem& problem) {
  Views out;
  out.planar = problem.planar();
  out.view.resize(problem.size());
  parallel_for(problem.size(), [&](std::size_t i) {
    const View& view = problem.views.view[i];
    const auto& burst = problem.burst[i];
    const std::size_t bursts =
        burst.empty() ? 0 : static_cast<std::size_t>(1 + *std::max_element(burst.begin(), burst.end()));
    std::vector<Eigen::Matrix3d> precision(bursts, Eigen::Matrix3d::Zero());
    std::vector<Eigen::Vector3d> sum(bursts, Eigen::Vector3d::Zero());
    for (const std::uint32_t j : problem.sampled[i]) {
      if (burst[j] < 0) continue;
      Eigen::Matrix3d c = matrix(view.covariance[j]);
      if (out.planar) c.row(2).setZero(), c.col(2).setZero(), c(2, 2) = 1;
      const auto b = static_cast<std::size_t>(burst[j]);
      const Eigen::Matrix3d inverse = c.inverse();
      precision[b] += inverse;
      sum[b] += inverse * view.points.col(static_cast<Eigen::Index>(j)).cast<double>();
    }
    std::vector<Eigen::Vector3f> point;
    for (std::size_t b = 0; b < bursts; ++b) {
      if (precision[b].isZero()) continue;
      const Eigen::Matrix3d covariance = precision[b].inverse();
      point.push_back((covariance * sum[b]).cast<float>());
      out.view[i].covariance.push_back(symmetric3(covariance));
    }
    out.view[i].points.resize(3, static_cast<Eigen::Index>(point.size()));
    for (std::size_t k = 0; k < point.size(); ++k)
      out.view[i].points.col(static_cast<Eigen::Index>(k)) = point[k];
  });
  return out;
}

// Views of one structure, each turned by a hidden element of the group: with which probability its spots
// carry a label. Expectation-maximisation over the elements. That a spot is dark says as much as that another
// is not, which a density forgets.
class Images {
 public:
  Images(const Problem& problem, const Fit& fit, const RotationGroup& group)
      : spot_(symmetrised(fit.mixture, group, 2 * typical_sigma(problem)).centre) {
    for (const Eigen::Matrix3d& g : group) {
      std::vector<std::size_t> to;
      for (Eigen::Index k = 0; k < spot_.cols(); ++k)
        to.push_back(static_cast<std::size_t>(nearest(spot_, g.cast<float>() * spot_.col(k))));
      image_.push_back(std::move(to));
    }
    for (Eigen::Index k = 0; k < fit.mixture.size(); ++k)
      spot_of_.push_back(static_cast<std::size_t>(nearest(spot_, fit.mixture.centre.col(k))));
    const Views seen = merged_bursts(problem);
    const FusionData data(seen, problem.axes, fit.noise);
    const std::size_t spots = static_cast<std::size_t>(spot_.cols());
    even_.assign(kLevels * spots, 0);
    double views = 0;
    for (const std::vector<double>& n : attributed(fit.mixture, data, fit.pose)) {
      std::vector<double> count(spots, 0.0);
      for (std::size_t k = 0; k < n.size(); ++k) count[spot_of_[k]] += n[k];
      std::vector<double> lit = n.empty() ? std::vector<double>() : levels(count);
      if (!lit.empty()) ++views;
      for (const auto& to : image_) add(lit, to, 1, even_);
      lit_.push_back(std::move(lit));
    }
    for (double& p : even_) p /= std::max(1.0, views) * static_cast<double>(group.size());
  }

  using Probabilities = std::vector<double>;  // of every spot and level

  /// The likeliest for the views `which` that is reached from what single ones show.
  Probabilities fitted(const std::vector<int>& which, const SymmetryOptions& o, std::uint64_t seed) const {
    Probabilities best;
    double most = -INFINITY;
    for (int k = 0; k < o.relabellings; ++k) {
      KeyedRandom random(seed, static_cast<std::uint64_t>(k), kReferenceStage);
      const std::vector<double>& reference =
          lit_[static_cast<std::size_t>(which[random.below(which.size())])];
      Probabilities now = even_;
      for (std::size_t s = 0; s < reference.size(); ++s) now[s] = 0.5 * (even_[s] + reference[s]);
      double reached = 0;
      for (int sweep = 0; sweep < o.relabelling_sweeps; ++sweep) now = stepped(now, which, o, reached);
      if (reached > most) most = reached, best = std::move(now);
    }
    return best;
  }
  const Probabilities& even() const { return even_; }

  /// ln of the probability of what a view shows, each element as likely as the others; NAN: it shows nothing.
  double log_likelihood(const Probabilities& probability, std::size_t view) const {
    double out = 0;
    if (lit_[view].empty()) return NAN;
    posterior(probability, lit_[view], out);
    return out;
  }
  double labels(std::size_t view) const {
    double sum = 0;
    for (std::size_t s = 0; s < lit_[view].size() / kLevels; ++s) sum += expected(lit_[view], s);
    return std::max(1.0, sum);
  }

  /// The likeliest element of a view.
  std::size_t element(const Probabilities& probability, std::size_t view) const {
    if (lit_[view].empty()) return 0;
    double total = 0;
    const std::vector<double> p = posterior(probability, lit_[view], total);
    return static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin());
  }

  /// What the weight of a centre of the template is multiplied with.
  double factor(const Probabilities& probability, Eigen::Index centre) const {
    const std::size_t s = spot_of_[static_cast<std::size_t>(centre)];
    return expected(probability, s) / std::max(expected(even_, s), 1e-9);
  }

 private:
  // Of every spot and level; a count between two levels is partly of both.
  static std::vector<double> levels(const std::vector<double>& count) {
    std::vector<double> out(kLevels * count.size(), 0.0);
    for (std::size_t s = 0; s < count.size(); ++s) {
      const double n = std::min(count[s], static_cast<double>(kLevels - 1));
      for (std::size_t l = 0; l < kLevels; ++l)
        out[s * kLevels + l] = std::max(0.0, 1 - std::abs(n - static_cast<double>(l)));
    }
    return out;
  }
  static double expected(const std::vector<double>& of_level, std::size_t spot) {
    double sum = 0;
    for (std::size_t l = 1; l < kLevels; ++l) sum += static_cast<double>(l) * of_level[spot * kLevels + l];
    return sum;
  }
  static void add(const std::vector<double>& lit, const std::vector<std::size_t>& to, double weight,
                  std::vector<double>& sum) {
    for (std::size_t k = 0; k < lit.size(); ++k)
      sum[to[k / kLevels] * kLevels + k % kLevels] += weight * lit[k];
  }

  // One step of expectation and maximisation; `reached`: ln likelihood before it.
  Probabilities stepped(const Probabilities& now, const std::vector<int>& which, const SymmetryOptions& o,
                        double& reached) const {
    Probabilities next = even_;
    for (double& p : next) p *= o.relabelling_views;
    double views = o.relabelling_views;
    reached = 0;
    for (const int v : which) {
      const std::vector<double>& lit = lit_[static_cast<std::size_t>(v)];
      if (lit.empty()) continue;
      const std::vector<double> p = posterior(now, lit, reached);
      for (std::size_t g = 0; g < p.size(); ++g) add(lit, image_[g], p[g], next);
      ++views;
    }
    for (double& p : next) p /= views;
    return next;
  }

  // Of the elements; adds ln of their sum to `total`.
  std::vector<double> posterior(const Probabilities& probability, const std::vector<double>& lit,
                                double& total) const {
    std::vector<double> log_probability, p;
    for (const double q : probability) log_probability.push_back(std::log(std::max(q, kLeast)));
    for (const auto& to : image_) {
      p.push_back(0);
      for (std::size_t s = 0; s < to.size(); ++s)
        for (std::size_t l = 0; l < kLevels; ++l)
          p.back() += lit[s * kLevels + l] * log_probability[to[s] * kLevels + l];
    }
    const double top = *std::max_element(p.begin(), p.end());
    double sum = 0;
    for (double& v : p) sum += v = std::exp(v - top);
    total += top + std::log(sum / static_cast<double>(p.size()));
    for (double& v : p) v /= sum;
    return p;
  }

  Eigen::Matrix3Xf spot_;
  std::vector<std::size_t> spot_of_;             // of every centre
  std::vector<std::vector<std::size_t>> image_;  // of every element: where it turns a spot to
  std::vector<std::vector<double>> lit_;         // of every view, spot and level
  Probabilities even_;                           // of every spot, the same over the group
};

// Every view's labels under probabilities that other views gave, with the group and without.
Comparison told_apart(const Images& images, const Problem& problem, const EngineOptions& options) {
  const auto folds = static_cast<std::size_t>(options.anneal.folds);
  Evidence with(problem.size(), NAN), without = with;
  for (std::size_t f = 0; f < folds; ++f) {
    std::vector<int> others;
    for (const int v : problem.all)
      if (static_cast<std::size_t>(v) % folds != f) others.push_back(v);
    if (others.empty()) continue;
    const Images::Probabilities p = images.fitted(others, options.symmetry, problem.seed);
    for (std::size_t i = f; i < problem.size(); i += folds) {
      with[i] = images.log_likelihood(images.even(), i) / images.labels(i);
      without[i] = images.log_likelihood(p, i) / images.labels(i);
    }
  }
  return compare(with, without);
}

}  // namespace

Relaxation relaxed(const Problem& problem, const EngineOptions& options, const Fit& symmetric) {
  const Images images(problem, symmetric, symmetric.group);
  Relaxation out{symmetric, told_apart(images, problem, options)};
  const Images::Probabilities p = images.fitted(problem.all, options.symmetry, problem.seed);
  out.fit.group.clear();
  for (std::size_t i = 0; i < problem.size(); ++i)
    out.fit.pose[i] =
        Pose{symmetric.group[images.element(p, i)], Eigen::Vector3d::Zero()} * symmetric.pose[i];
  Eigen::VectorXf& weight = out.fit.mixture.weight;
  for (Eigen::Index k = 0; k < weight.size(); ++k) weight[k] *= static_cast<float>(images.factor(p, k));
  weight /= weight.sum();
  return out;
}

}  // namespace polar
