#include "label_spots.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/covariance3.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/occupancy.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kReferenceStage = 45;
constexpr double kLeast = 0.01;  // probability of a label, and of none, at any spot

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

// A spot's number of expected labels, turned to where an element takes it.
void add(const std::vector<double>& lit, const std::vector<std::size_t>& to, double weight,
         std::vector<double>& sum) {
  for (std::size_t s = 0; s < lit.size(); ++s) sum[to[s]] += weight * lit[s];
}

}  // namespace

LabelSpots::LabelSpots(const Problem& problem, const Fit& symmetric) {
  const RotationGroup& group = symmetric.group;
  const Eigen::Matrix3Xf spot = symmetrised(symmetric.mixture, group, 2 * typical_sigma(problem)).centre;
  for (const Eigen::Matrix3d& g : group) {
    std::vector<std::size_t> to;
    for (Eigen::Index k = 0; k < spot.cols(); ++k)
      to.push_back(static_cast<std::size_t>(nearest(spot, g.cast<float>() * spot.col(k))));
    image_.push_back(std::move(to));
  }
  for (Eigen::Index k = 0; k < symmetric.mixture.size(); ++k)
    spot_of_.push_back(static_cast<std::size_t>(nearest(spot, symmetric.mixture.centre.col(k))));
  const Views seen = merged_bursts(problem);
  const FusionData data(seen, problem.axes, symmetric.noise);
  const auto spots = static_cast<std::size_t>(spot.cols());
  even_.assign(spots, 0);
  double views = 0;
  for (const std::vector<double>& n : attributed(symmetric.mixture, data, symmetric.pose)) {
    std::vector<double> lit(n.empty() ? 0 : spots, 0.0);
    for (std::size_t k = 0; k < n.size(); ++k) lit[spot_of_[k]] += n[k];
    for (double& s : lit) s = std::min(1.0, s);
    if (!lit.empty()) ++views;
    for (const auto& to : image_) add(lit, to, 1, even_);
    lit_.push_back(std::move(lit));
  }
  for (double& p : even_) p /= std::max(1.0, views) * static_cast<double>(group.size());
}

LabelSpots::Probabilities LabelSpots::fitted(const std::vector<int>& which, const SymmetryOptions& options,
                                             std::uint64_t seed) const {
  Probabilities best = even_;
  double most = -INFINITY;
  for (int k = 0; k < options.relabellings; ++k) {
    KeyedRandom random(seed, static_cast<std::uint64_t>(k), kReferenceStage);
    const std::vector<double>& reference = lit_[static_cast<std::size_t>(which[random.below(which.size())])];
    Probabilities now = even_;
    for (std::size_t s = 0; s < reference.size(); ++s) now[s] = 0.5 * (even_[s] + reference[s]);
    double reached = 0;
    for (int sweep = 0; sweep < options.relabelling_sweeps; ++sweep)
      now = stepped(now, which, options, reached);
    if (reached > most) most = reached, best = std::move(now);
  }
  return best;
}

double LabelSpots::log_likelihood(const Probabilities& probability, std::size_t view) const {
  if (lit_[view].empty()) return NAN;
  double out = 0;
  posterior(probability, lit_[view], out);
  return out;
}

double LabelSpots::labels(std::size_t view) const {
  return std::max(1.0, std::accumulate(lit_[view].begin(), lit_[view].end(), 0.0));
}

std::size_t LabelSpots::element(const Probabilities& probability, std::size_t view) const {
  if (lit_[view].empty()) return 0;
  double total = 0;
  const std::vector<double> p = posterior(probability, lit_[view], total);
  return static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin());
}

double LabelSpots::factor(const Probabilities& probability, Eigen::Index centre) const {
  const std::size_t s = spot_of_[static_cast<std::size_t>(centre)];
  return probability[s] / std::max(even_[s], 1e-9);
}

// One step of expectation and maximisation; `reached`: ln likelihood before it.
LabelSpots::Probabilities LabelSpots::stepped(const Probabilities& now, const std::vector<int>& which,
                                              const SymmetryOptions& options, double& reached) const {
  Probabilities next = even_;
  double views = options.relabelling_views;
  for (double& p : next) p *= views;
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

// Of the elements; adds ln of their mean to `total`.
std::vector<double> LabelSpots::posterior(const Probabilities& probability, const std::vector<double>& lit,
                                          double& total) const {
  std::vector<double> on, off, p;
  for (const double q : probability) {
    on.push_back(std::log(std::max(q, kLeast)));
    off.push_back(std::log(std::max(1 - q, kLeast)));
  }
  for (const auto& to : image_) {
    p.push_back(0);
    for (std::size_t s = 0; s < to.size(); ++s) p.back() += (1 - lit[s]) * off[to[s]] + lit[s] * on[to[s]];
  }
  const double top = *std::max_element(p.begin(), p.end());
  double sum = 0;
  for (double& v : p) sum += v = std::exp(v - top);
  total += top + std::log(sum / static_cast<double>(p.size()));
  for (double& v : p) v /= sum;
  return p;
}

}  // namespace polar
