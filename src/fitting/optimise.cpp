#include "optimise.hpp"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace polar::fitting {

namespace {
constexpr double kFunctionTolerance = 1e-10;  // relative; log densities are sums of thousands
constexpr double kInside = 1e-6;              // of a range: a start keeps so far from its bounds
constexpr double kMostLogit = 30;             // beyond, a bound is reached in floating point
constexpr double kUnit = 0.1;                 // what Ceres sees as 1: of a parameter's size, or radians
constexpr double kLeastSize = 1e-2;           // of a parameter, of its range

// Between what Ceres moves (unbounded; its first steps are about 1) and theta.
class Coordinates {
 public:
  Coordinates(const Objective& o, const Eigen::VectorXd& start) : o_(o), theta_(start) {
    const double shift_nm = kUnit * std::max(1.0, o.data.extent_nm());
    for (std::size_t i = 0; i < o.free.size(); ++i) {
      if (!o.free[i]) continue;
      index_.push_back(i);
      unit_.push_back(is_model(i) ? logit_unit(i) : is_turn(i) ? kUnit : shift_nm);
    }
  }

  int size() const { return static_cast<int>(index_.size()); }

  std::vector<double> from(const Eigen::VectorXd& theta) const {
    std::vector<double> u;
    for (std::size_t k = 0; k < index_.size(); ++k) {
      const double t = theta[static_cast<Eigen::Index>(index_[k])];
      const double s = is_model(index_[k]) ? inside(index_[k], t) : 0;
      u.push_back((is_model(index_[k]) ? std::log(s / (1 - s)) : t) / unit_[k]);
    }
    return u;
  }

  // d theta / d u goes to `slope`.
  Eigen::VectorXd to(const double* u, std::vector<double>& slope) const {
    Eigen::VectorXd theta = theta_;
    slope = unit_;
    for (std::size_t k = 0; k < index_.size(); ++k) {
      double& t = theta[static_cast<Eigen::Index>(index_[k])];
      t = u[k] * unit_[k];
      if (!is_model(index_[k])) continue;
      const ModelParameter& p = o_.model.parameter[index_[k]];
      const double s = 1 / (1 + std::exp(-std::clamp(t, -kMostLogit, kMostLogit)));
      t = p.low + (p.high - p.low) * s;
      slope[k] *= (p.high - p.low) * s * (1 - s);
    }
    return theta;
  }

  const std::vector<std::size_t>& index() const { return index_; }

 private:
  bool is_model(std::size_t i) const { return i < o_.model.parameter.size(); }
  bool is_turn(std::size_t i) const { return i < o_.model.parameter.size() + 3; }

  double inside(std::size_t i, double t) const {
    const ModelParameter& p = o_.model.parameter[i];
    return std::clamp((t - p.low) / (p.high - p.low), kInside, 1 - kInside);
  }
  // Logits by which the parameter changes by kUnit of its size.
  double logit_unit(std::size_t i) const {
    const ModelParameter& p = o_.model.parameter[i];
    const double t = theta_[static_cast<Eigen::Index>(i)], range = p.high - p.low, s = inside(i, t);
    return std::min(1.0, kUnit * std::max(std::abs(t), kLeastSize * range) / (range * s * (1 - s)));
  }

  const Objective& o_;
  Eigen::VectorXd theta_;
  std::vector<std::size_t> index_;
  std::vector<double> unit_;
};

class NegativeLogLikelihood : public ceres::FirstOrderFunction {
 public:
  NegativeLogLikelihood(const Objective& o, const Coordinates& coordinates)
      : o_(o), coordinates_(coordinates) {}

  int NumParameters() const override { return coordinates_.size(); }

  bool Evaluate(const double* u, double* cost, double* gradient) const override {
    std::vector<double> slope;
    const Eigen::VectorXd theta = coordinates_.to(u, slope);
    const GroupScores scores = group_scores(
        o_.data, density_of(o_.model, o_.counts, o_.data_from_model, theta, gradient != nullptr));
    const Eigen::VectorXd step = theta.tail<kPlacement>();
    *cost = 0.5 * step.cwiseAbs2().dot(o_.prior_weight) - scores.log_density.sum();
    if (gradient) {
      Eigen::VectorXd g = -scores.gradient.rowwise().sum();
      g.tail<kPlacement>() += o_.prior_weight.cwiseProduct(step);
      for (std::size_t k = 0; k < slope.size(); ++k)
        gradient[k] = slope[k] * g[static_cast<Eigen::Index>(coordinates_.index()[k])];
    }
    return std::isfinite(*cost);
  }

 private:
  const Objective& o_;
  const Coordinates& coordinates_;
};
// Ceres warns on stderr of line searches that end well.
void silence_ceres() {
  static const bool done = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  (void)done;
}
}  // namespace

Optimum optimise(const Objective& objective, const Eigen::VectorXd& start, int most_iterations) {
  silence_ceres();
  Optimum out{start};
  const Coordinates coordinates(objective, start);
  std::vector<double> u = coordinates.from(start), slope;
  ceres::GradientProblem problem(new NegativeLogLikelihood(objective, coordinates));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = most_iterations;
  options.function_tolerance = kFunctionTolerance;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, u.data(), &summary);
  out.theta = coordinates.to(u.data(), slope);
  out.objective = summary.final_cost;
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  return out;
}

}  // namespace polar::fitting
