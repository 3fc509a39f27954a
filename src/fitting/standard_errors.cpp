#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "optimise.hpp"

namespace polar::fitting {

namespace {
constexpr double kDifference = 1e-4;  // of a parameter's size: step of the second derivative
constexpr double kLeastSize = 1e-2;   // of a parameter, of its range
constexpr double kTurnSize = 1, kShiftSize_nm = 10;
constexpr double kOpen = 1e-9;     // of the largest eigenvalue: what lies below is not determined
constexpr double kTouched = 0.05;  // share of a parameter in an open direction from which it is open

std::vector<Eigen::Index> free_parameters(const Objective& o) {
  std::vector<Eigen::Index> index;
  for (std::size_t i = 0; i < o.free.size(); ++i)
    if (o.free[i]) index.push_back(static_cast<Eigen::Index>(i));
  return index;
}

double size_of(const Objective& o, Eigen::Index i, double value) {
  const auto n = static_cast<Eigen::Index>(o.model.parameter.size());
  if (i >= n) return i < n + 3 ? kTurnSize : kShiftSize_nm;
  const ModelParameter& p = o.model.parameter[static_cast<std::size_t>(i)];
  return std::max(std::abs(value), kLeastSize * (p.high - p.low));
}

Eigen::MatrixXd gradients(const Objective& o, const Eigen::VectorXd& theta) {
  return group_scores(o.data, density_of(o.model, o.counts, o.data_from_model, theta, true)).gradient;
}

// Scores and observed informations of all groups, in units of the parameters' sizes.
struct Groups {
  std::vector<Eigen::VectorXd> score;
  std::vector<Eigen::MatrixXd> information;
};

Groups groups_at(const Objective& o, const Eigen::VectorXd& theta, const std::vector<Eigen::Index>& index,
                 const Eigen::VectorXd& size) {
  const auto n = static_cast<Eigen::Index>(index.size());
  Groups out;
  const Eigen::MatrixXd here = gradients(o, theta);
  out.information.assign(static_cast<std::size_t>(o.data.groups), Eigen::MatrixXd::Zero(n, n));
  for (Eigen::Index g = 0; g < o.data.groups; ++g) {
    out.score.emplace_back(n);
    for (Eigen::Index a = 0; a < n; ++a)
      out.score.back()[a] = size[a] * here(index[static_cast<std::size_t>(a)], g);
  }
  for (Eigen::Index b = 0; b < n; ++b) {
    Eigen::VectorXd moved = theta;
    const Eigen::Index at = index[static_cast<std::size_t>(b)];
    moved[at] = theta[at] + kDifference * size[b];
    const Eigen::MatrixXd up = gradients(o, moved);
    moved[at] = theta[at] - kDifference * size[b];
    const Eigen::MatrixXd change = (gradients(o, moved) - up) / (2 * kDifference);
    for (Eigen::Index g = 0; g < o.data.groups; ++g)
      for (Eigen::Index a = 0; a < n; ++a)
        out.information[static_cast<std::size_t>(g)](a, b) =
            size[a] * change(index[static_cast<std::size_t>(a)], g);
  }
  for (Eigen::MatrixXd& h : out.information) h = 0.5 * (h + h.transpose()).eval();
  return out;
}

// Inverse where it is determined; which parameters are not goes to `open`.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& information, std::vector<bool>& open) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double least = kOpen * values.maxCoeff();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(information.rows(), information.cols());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const Eigen::VectorXd v = eigen.eigenvectors().col(k);
    if (values[k] > least && least > 0)
      out += v * v.transpose() / values[k];
    else
      for (Eigen::Index a = 0; a < v.size(); ++a)
        if (v[a] * v[a] > kTouched) open[static_cast<std::size_t>(a)] = true;
  }
  return out;
}

Eigen::MatrixXd jackknife(const Groups& groups, const Eigen::MatrixXd& information,
                          const Eigen::MatrixXd& inverse_information) {
  const auto count = static_cast<double>(groups.score.size());
  std::vector<Eigen::VectorXd> change;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(information.rows());
  for (std::size_t g = 0; g < groups.score.size(); ++g) {
    const Eigen::LLT<Eigen::MatrixXd> without(information - groups.information[g]);
    // Where nothing is determined without a group, it is left in.
    change.push_back(without.info() == Eigen::Success
                         ? Eigen::VectorXd(without.solve(groups.score[g]))
                         : Eigen::VectorXd(inverse_information * groups.score[g]));
    mean += change.back() / count;
  }
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(information.rows(), information.cols());
  for (const Eigen::VectorXd& c : change) sum += (c - mean) * (c - mean).transpose();
  return (count - 1) / count * sum;
}
}  // namespace

Eigen::MatrixXd covariance_at(const Objective& o, const Eigen::VectorXd& theta) {
  const std::vector<Eigen::Index> index = free_parameters(o);
  const auto n = static_cast<Eigen::Index>(index.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  if (n == 0) return out;
  Eigen::VectorXd size(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const Eigen::Index i = index[static_cast<std::size_t>(a)];
    size[a] = size_of(o, i, theta[i]);
  }
  const Groups groups = groups_at(o, theta, index, size);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& h : groups.information) information += h;
  const auto first_of_placement = static_cast<Eigen::Index>(o.model.parameter.size());
  for (Eigen::Index a = 0; a < n; ++a) {
    const Eigen::Index i = index[static_cast<std::size_t>(a)];
    if (i >= first_of_placement)
      information(a, a) += size[a] * size[a] * o.prior_weight[i - first_of_placement];
  }
  std::vector<bool> open(static_cast<std::size_t>(n), false);
  const Eigen::MatrixXd plain = inverse(information, open);
  const Eigen::MatrixXd covariance = o.data.groups > n ? jackknife(groups, information, plain) : plain;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const bool told = !open[static_cast<std::size_t>(a)] && !open[static_cast<std::size_t>(b)];
      out(index[static_cast<std::size_t>(a)], index[static_cast<std::size_t>(b)]) =
          told ? size[a] * size[b] * covariance(a, b) : kNone;
    }
  return out;
}

}  // namespace polar::fitting
