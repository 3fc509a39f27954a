#include "optimise.hpp"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace polar::fitting {

namespace {
constexpr double kFunctionTolerance = 1e-10;  // relative; log densities are sums of thousands
constexpr double kInside = 1e-6;              // of a range: a start keeps so far from its bounds
constexpr double kMostLogit = 30;             // beyond, a bound is reached in floating point

// Between what Ceres moves (unbounded, nm or of order 1) and theta.
class Coordinates {
 public:
  Coordinates(const Objective& o, const Eigen::VectorXd& start)
      : o_(o), theta_(start), length_nm_(std::max(1.0, o.data.extent_nm())) {
    for (std::size_t i = 0; i < o.free.size(); ++i)
      if (o.free[i]) index_.push_back(i);
  }

  int size() const { return static_cast<int>(index_.size()); }

  std::vector<double> from(const Eigen::VectorXd& theta) const {
    std::vector<double> u;
    for (const std::size_t i : index_) {
      const double t = theta[static_cast<Eigen::Index>(i)];
      if (is_model(i)) {
        const ModelParameter& p = o_.model.parameter[i];
        const double s = std::clamp((t - p.low) / (p.high - p.low), kInside, 1 - kInside);
        u.push_back(std::log(s / (1 - s)));
      } else {
        u.push_back(is_turn(i) ? t * length_nm_ : t);
      }
    }
    return u;
  }

  // d theta / d u goes to `slope`.
  Eigen::VectorXd to(const double* u, std::vector<double>& slope) const {
    Eigen::VectorXd theta = theta_;
    slope.resize(index_.size());
    for (std::size_t k = 0; k < index_.size(); ++k) {
      const std::size_t i = index_[k];
      double& t = theta[static_cast<Eigen::Index>(i)];
      if (is_model(i)) {
        const ModelParameter& p = o_.model.parameter[i];
        const double s = 1 / (1 + std::exp(-std::clamp(u[k], -kMostLogit, kMostLogit)));
        t = p.low + (p.high - p.low) * s;
        slope[k] = (p.high - p.low) * s * (1 - s);
      } else {
        slope[k] = is_turn(i) ? 1 / length_nm_ : 1;
        t = u[k] * slope[k];
      }
    }
    return theta;
  }

  const std::vector<std::size_t>& index() const { return index_; }

 private:
  bool is_model(std::size_t i) const { return i < o_.model.parameter.size(); }
  bool is_turn(std::size_t i) const { return i < o_.model.parameter.size() + 3; }

  const Objective& o_;
  Eigen::VectorXd theta_;
  double length_nm_;
  std::vector<std::size_t> index_;
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
}  // namespace

Optimum optimise(const Objective& objective, const Eigen::VectorXd& start, int most_iterations) {
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
