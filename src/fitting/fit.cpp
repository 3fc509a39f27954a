#include "polar/fitting/fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "optimise.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/flames/rotation_grid.hpp"

namespace polar::fitting {

namespace {
// Points this many of a localisation's standard deviations apart: a chain of Gaussians is even to exp(-2 pi^2
// / 1.2^2), one in a million.
constexpr double kSpacing = 1.2;
constexpr double kFinest = 0.1;  // quantile of the standard deviations that must be served
constexpr double kCoarse = 0.1;  // of the extent: spacing while starts are chosen
constexpr int kStartIterations = 30, kIterations = 300, kRefinements = 4;
constexpr std::size_t kFinalists = 3;
constexpr std::size_t kMostForFinalists = 5000;  // localisations
constexpr double kWideTurn_rad = 1;              // prior of a placement that is not known
constexpr double kAtBound = 1e-4;                // of a range
constexpr std::uint32_t kSomeStage = 0xf2;

double finest_sigma_nm(const FitData& data) {
  std::vector<double> sigma;
  for (const Eigen::Matrix3d& c : data.covariance_nm2) {
    const double least =
        data.planar
            ? Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(c.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly)
                  .eigenvalues()[0]
            : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(c, Eigen::EigenvaluesOnly).eigenvalues()[0];
    sigma.push_back(std::sqrt(std::max(0.0, least)));
  }
  return quantile(std::move(sigma), kFinest);
}

double spacing_nm(const FitData& data, double width_nm) {
  return kSpacing * std::hypot(finest_sigma_nm(data), width_nm);
}

std::vector<double> model_values(const GeometricModel& model, const Eigen::VectorXd& theta) {
  return {theta.data(), theta.data() + model.parameter.size()};
}

FitData random_part(const FitData& data, std::size_t most, std::uint64_t seed) {
  if (data.size() <= most) return data;
  std::vector<std::uint32_t> order = random_order(data.size(), KeyedRandom(seed, data.size(), kSomeStage));
  order.resize(most);
  std::sort(order.begin(), order.end());
  return some_of(data, order);
}

std::vector<bool> free_placement(bool planar, bool any) {
  return planar ? std::vector<bool>{false, false, any, any, any, false} : std::vector<bool>(6, any);
}

Eigen::VectorXd prior(double turn_rad, double shift_nm) {
  Eigen::VectorXd weight(6);
  weight.head<3>().setConstant(1 / (turn_rad * turn_rad));
  weight.tail<3>().setConstant(1 / (shift_nm * shift_nm));
  return weight;
}

// The placement's step becomes part of the pose.
void absorb(Objective& o, Eigen::VectorXd& theta) {
  const Eigen::Vector3d turn = theta.tail<6>().head<3>();
  o.data_from_model.rotation = so3_exp(turn) * o.data_from_model.rotation;
  o.data_from_model.translation += theta.tail<3>();
  theta.tail<6>().setZero();
}

// Until the points are as dense as the width that was found asks for.
Optimum refine(Objective& o, Eigen::VectorXd theta, bool moves_prior) {
  Optimum best{theta};
  for (int round = 0; round < kRefinements; ++round) {
    const Counts counts =
        counts_for(o.model, model_values(o.model, theta), spacing_nm(o.data, theta[kWidth]));
    if (round > 0 && counts == o.counts) break;
    o.counts = counts;
    best = optimise(o, theta, kIterations);
    if (moves_prior) absorb(o, best.theta);
    theta = best.theta;
  }
  return best;
}

ModelFit finished(Objective& o, const Optimum& optimum, const std::vector<bool>& held) {
  const GeometricModel& model = o.model;
  const auto n = static_cast<Eigen::Index>(model.parameter.size());
  ModelFit fit;
  fit.value = optimum.theta.head(n);
  fit.held = held;
  fit.localisations = static_cast<int>(o.data.size()), fit.groups = o.data.groups;
  fit.converged = optimum.converged;
  fit.reason = optimum.converged ? "" : "the search did not converge";
  for (std::size_t i = 0; i < model.parameter.size(); ++i) {
    const ModelParameter& p = model.parameter[i];
    const double v = fit.value[static_cast<Eigen::Index>(i)], margin = kAtBound * (p.high - p.low);
    fit.at_bound.push_back(!held[i] && (v < p.low + margin || v > p.high - margin));
    if (fit.at_bound.back()) o.free[i] = false;
  }
  fit.covariance = covariance_at(o, optimum.theta).topLeftCorner(n, n);
  fit.log_density = group_scores(o.data, density_of(model, o.counts, o.data_from_model, optimum.theta, false))
                        .log_density.sum() /
                    static_cast<double>(o.data.size());
  Eigen::VectorXd theta = optimum.theta;
  absorb(o, theta);
  fit.data_from_model = o.data_from_model;
  return fit;
}

// Derivatives by central differences: a formula of few values, evaluated twice each.
void derive(const GeometricModel& model, ModelFit& fit) {
  constexpr double kStep = 1e-5;
  const auto n = static_cast<Eigen::Index>(model.parameter.size());
  fit.derived.resize(static_cast<Eigen::Index>(model.derived.size())), fit.derived_std = fit.derived;
  for (std::size_t d = 0; d < model.derived.size(); ++d) {
    std::vector<double> v = model_values(model, fit.value);
    const auto row = static_cast<Eigen::Index>(d);
    fit.derived[row] = model.derived[d].value.at(v);
    Eigen::VectorXd slope(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      double& x = v[static_cast<std::size_t>(i)];
      const double x0 = x, h = kStep * std::max(1.0, std::abs(x));
      x = x0 + h;
      const double up = model.derived[d].value.at(v);
      x = x0 - h;
      slope[i] = (up - model.derived[d].value.at(v)) / (2 * h);
      x = x0;
    }
    double variance = 0;  // a parameter that it does not depend on may be open
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        if (slope[i] != 0 && slope[j] != 0) variance += slope[i] * slope[j] * fit.covariance(i, j);
    fit.derived_std[row] = std::sqrt(variance);
  }
}

struct Candidate {
  Eigen::VectorXd theta;
  Pose data_from_model;
  double objective = 0;
};

// All combinations of the parameters' starts, the first parameter's fastest.
std::vector<Eigen::VectorXd> parameter_starts(const GeometricModel& model, double extent_nm) {
  const auto n = static_cast<Eigen::Index>(model.parameter.size());
  std::vector<Eigen::VectorXd> all = {Eigen::VectorXd::Zero(n + 6)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const ModelParameter& p = model.parameter[static_cast<std::size_t>(i)];
    std::vector<Eigen::VectorXd> next;
    for (const Expression& start : p.start)
      for (Eigen::VectorXd theta : all) {
        theta[i] = std::clamp(start.at(std::vector<double>{extent_nm}), p.low, p.high);
        next.push_back(theta);
      }
    all = std::move(next);
  }
  return all;
}

std::vector<Eigen::Matrix3d> orientations(int count, bool planar) {
  std::vector<Eigen::Matrix3d> all = {Eigen::Matrix3d::Identity()};
  for (const Eigen::Quaternionf& q : planar ? planar_rotations(count) : super_fibonacci(count))
    all.push_back(q.cast<double>().normalized().toRotationMatrix());
  return all;
}
}  // namespace

std::vector<std::string> violations(const FitOptions& o) {
  std::vector<std::string> faults;
  const auto require = [&](bool holds, const char* sentence) {
    if (!holds) faults.emplace_back(sentence);
  };
  require(o.starts >= 1 && o.starts <= 10000, "starts must be 1 to 10000");
  require(o.pose_std_deg > 0 && o.pose_std_deg <= 180, "pose_std_deg must be above 0, at most 180");
  require(o.pose_std_nm > 0 && o.pose_std_nm <= 1e6, "pose_std_nm must be above 0, at most a million");
  require(o.burst_distance >= 0 && o.burst_distance <= 100, "burst_distance must be 0 to 100");
  require(o.most_for_starts >= 10, "most_for_starts must be 10 or more");
  return faults;
}

double ModelFit::std_error(std::size_t parameter) const {
  const auto i = static_cast<Eigen::Index>(parameter);
  return held[parameter] || at_bound[parameter] ? NAN : std::sqrt(covariance(i, i));
}

ModelFit fit_from_starts(const GeometricModel& model, const FitData& data, const FitOptions& options) {
  const double extent_nm = std::max(1e-3, data.extent_nm());
  const FitData few = random_part(data, static_cast<std::size_t>(options.most_for_starts), options.seed);
  const std::vector<Eigen::VectorXd> starts = parameter_starts(model, extent_nm);
  const std::vector<Eigen::Matrix3d> turns = orientations(options.starts, data.planar);
  std::vector<bool> free, held;
  for (const ModelParameter& p : model.parameter) free.push_back(!p.fixed), held.push_back(p.fixed);
  for (const bool f : free_placement(data.planar, true)) free.push_back(f);
  const Eigen::VectorXd wide = prior(kWideTurn_rad, extent_nm);
  const Eigen::Vector3d centre_nm = data.centre_nm();

  std::vector<Candidate> candidate(starts.size() * turns.size());
  parallel_for(candidate.size(), [&](std::size_t i) {
    Candidate& c = candidate[i];
    const Eigen::VectorXd& start = starts[i % starts.size()];
    Objective o{model, few,  counts_for(model, model_values(model, start), kCoarse * extent_nm),
                {},    free, wide};
    const Density own = density_of(model, o.counts, Pose{}, start, false);
    const Eigen::ArrayXd weight = own.log_weight.exp();
    const Eigen::Vector3d middle((weight * own.x).sum(), (weight * own.y).sum(), (weight * own.z).sum());
    o.data_from_model.rotation = turns[i / starts.size()];
    o.data_from_model.translation = centre_nm - o.data_from_model.rotation * middle;
    o.free[kWidth] = o.free[kBackground] = false;  // wide first: a narrow model falls for a cluster
    const Eigen::VectorXd wide_fit = optimise(o, start, kStartIterations).theta;
    o.free = free;
    const Optimum found = optimise(o, wide_fit, kStartIterations);
    c.theta = found.theta, c.objective = found.objective;
    absorb(o, c.theta);
    c.data_from_model = o.data_from_model;
  });
  std::stable_sort(candidate.begin(), candidate.end(),
                   [](const Candidate& a, const Candidate& b) { return a.objective < b.objective; });
  candidate.resize(std::min(candidate.size(), kFinalists));

  const FitData more = random_part(data, kMostForFinalists, options.seed);
  parallel_for(candidate.size(), [&](std::size_t i) {
    Candidate& c = candidate[i];
    Objective o{model, more, {}, c.data_from_model, free, wide};
    const Optimum found = refine(o, c.theta, true);
    c = {found.theta, o.data_from_model, found.objective};
  });
  const Candidate& best =
      *std::min_element(candidate.begin(), candidate.end(),
                        [](const Candidate& a, const Candidate& b) { return a.objective < b.objective; });
  Objective o{model, data, {}, best.data_from_model, free, wide};
  const Optimum optimum = refine(o, best.theta, true);
  ModelFit fit = finished(o, optimum, held);
  derive(model, fit);
  return fit;
}

ModelFit fit_near(const GeometricModel& model, const FitData& data, const ModelFit& near,
                  const FitOptions& options) {
  std::vector<bool> free, held;
  for (const ModelParameter& p : model.parameter)
    held.push_back(p.shared || p.fixed), free.push_back(!held.back());
  for (const bool f : free_placement(data.planar, options.free_pose)) free.push_back(f);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(near.value.size() + 6);
  theta.head(near.value.size()) = near.value;
  Objective o{model, data,
              {},    near.data_from_model,
              free,  prior(options.pose_std_deg * kRadiansPerDegree, options.pose_std_nm)};
  const Optimum optimum = refine(o, theta, false);
  ModelFit fit = finished(o, optimum, held);
  derive(model, fit);
  return fit;
}

namespace {
Density density_of_fit(const GeometricModel& model, const FitData& data, const ModelFit& fit) {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(fit.value.size() + 6);
  theta.head(fit.value.size()) = fit.value;
  const Counts counts = counts_for(model, model_values(model, theta), spacing_nm(data, theta[kWidth]));
  return density_of(model, counts, fit.data_from_model, theta, false);
}
}  // namespace

double mean_log_density(const GeometricModel& model, const FitData& data, const ModelFit& fit) {
  return log_densities(data, density_of_fit(model, data, fit)).mean();
}

ModelPoints points_of_fit(const GeometricModel& model, const FitData& data, const ModelFit& fit) {
  const Density d = density_of_fit(model, data, fit);
  ModelPoints out{Eigen::Matrix3Xd(3, d.x.size()), d.log_weight.exp().matrix()};
  out.x_nm.row(0) = d.x.transpose(), out.x_nm.row(1) = d.y.transpose(), out.x_nm.row(2) = d.z.transpose();
  return out;
}

}  // namespace polar::fitting
