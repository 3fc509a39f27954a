#include "likelihood.hpp"

#include <ceres/jet.h>
#include <ceres/rotation.h>

#include <Eigen/Dense>

#include "polar/core/parallel.hpp"

namespace polar::fitting {

namespace {
using Jet = ceres::Jet<double, kMostParameters>;

// What a localisation needs of its covariance widened by the model's width.
struct Widened {
  Eigen::Matrix3d precision = Eigen::Matrix3d::Zero();  // planar: without z
  double log_norm = 0;                                  // of N(0; 0, C)
};

Widened widened(const Eigen::Matrix3d& covariance, double width, bool planar) {
  Widened w;
  const Eigen::Matrix3d c = covariance + width * width * Eigen::Matrix3d::Identity();
  if (planar) {
    const Eigen::Matrix2d across = c.topLeftCorner<2, 2>();
    w.precision.topLeftCorner<2, 2>() = across.inverse();
    w.log_norm = -std::log(kTwoPi) - 0.5 * std::log(across.determinant());
  } else {
    w.precision = c.inverse();
    w.log_norm = -1.5 * std::log(kTwoPi) - 0.5 * std::log(c.determinant());
  }
  return w;
}

// One localisation under all points. `gradient` collects derivatives by the 4 K numbers of the points, and by
// width and background.
class Localisation {
 public:
  explicit Localisation(const Density& d)
      : density_(d), dx_(d.x.size()), dy_(d.x.size()), dz_(d.x.size()), q_(d.x.size()) {}

  double log_density(const Eigen::Vector3d& x, const Eigen::Matrix3d& covariance, double background_density,
                     bool planar) {
    w_ = widened(covariance, density_.width, planar);
    const Eigen::Matrix3d& p = w_.precision;
    dx_ = x.x() - density_.x, dy_ = x.y() - density_.y, dz_ = x.z() - density_.z;
    q_ = density_.log_weight - 0.5 * (dx_ * (p(0, 0) * dx_ + 2 * (p(0, 1) * dy_ + p(0, 2) * dz_)) +
                                      dy_ * (p(1, 1) * dy_ + 2 * p(1, 2) * dz_) + p(2, 2) * dz_ * dz_);
    const double most = q_.maxCoeff();
    q_ = (q_ - most).exp();
    const double sum = q_.sum();
    const double log_structure = w_.log_norm + most + std::log(sum);
    const double structure = std::exp(log_structure);
    const double b = density_.background;
    const double log_p = std::log((1 - b) * structure + b * background_density);
    // Where background is 0 and all is far away the density is 0 in floating point, its logarithm is not.
    const double log_density = b > 0 ? log_p : log_structure;
    share_ = b > 0 ? (1 - b) * structure / std::exp(log_p) : 1;
    by_background_ = b > 0 ? (background_density - structure) / std::exp(log_p) : 0;
    q_ *= share_ / sum;  // responsibilities
    return log_density;
  }

  const Eigen::ArrayXd& responsibility() const { return q_; }

  void add_gradient(Eigen::ArrayXd& points, double& width, double& background) {
    const Eigen::Matrix3d& p = w_.precision;
    const Eigen::Index k = q_.size();
    const auto add = [&](Eigen::Index row) {  // q P d, and its share of the derivative by the variance
      scratch_ = p(row, 0) * dx_ + p(row, 1) * dy_ + p(row, 2) * dz_;
      points.segment(row * k, k) += q_ * scratch_;
      return (q_ * scratch_.square()).sum();
    };
    const double squares = add(0) + add(1) + add(2);
    points.tail(k) += q_;
    width += density_.width * (squares - share_ * p.trace());
    background += by_background_;
  }

 private:
  const Density& density_;
  Widened w_;
  Eigen::ArrayXd dx_, dy_, dz_, q_, scratch_;
  double share_ = 0, by_background_ = 0;
};

template <class T>
std::vector<T> model_parameters(const GeometricModel& model, const std::vector<T>& theta) {
  return {theta.begin(), theta.begin() + static_cast<std::ptrdiff_t>(model.parameter.size())};
}

// Points in the frame of the data.
template <class T>
std::vector<WeightedPoint<T>> placed(const GeometricModel& model, const Counts& counts, const Pose& pose,
                                     const std::vector<T>& theta) {
  const std::size_t n = model.parameter.size();
  const T turn[3] = {theta[n], theta[n + 1], theta[n + 2]};
  std::vector<WeightedPoint<T>> points = points_of(model, counts, model_parameters(model, theta));
  const Eigen::Matrix3d& r = pose.rotation;
  for (WeightedPoint<T>& m : points) {
    const T base[3] = {r(0, 0) * m.x + r(0, 1) * m.y + r(0, 2) * m.z,
                       r(1, 0) * m.x + r(1, 1) * m.y + r(1, 2) * m.z,
                       r(2, 0) * m.x + r(2, 1) * m.y + r(2, 2) * m.z};
    T turned[3];
    ceres::AngleAxisRotatePoint(turn, base, turned);
    m.x = turned[0] + pose.translation.x() + theta[n + 3];
    m.y = turned[1] + pose.translation.y() + theta[n + 4];
    m.z = turned[2] + pose.translation.z() + theta[n + 5];
  }
  return points;
}

void fill(Density& d, const std::vector<WeightedPoint<double>>& points) {
  const auto k = static_cast<Eigen::Index>(points.size());
  d.x.resize(k), d.y.resize(k), d.z.resize(k), d.log_weight.resize(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const WeightedPoint<double>& m = points[static_cast<std::size_t>(i)];
    d.x[i] = m.x, d.y[i] = m.y, d.z[i] = m.z, d.log_weight[i] = std::log(m.weight);
  }
}

void fill(Density& d, const std::vector<WeightedPoint<Jet>>& points, Eigen::Index parameters) {
  const auto k = static_cast<Eigen::Index>(points.size());
  d.jacobian.resize(4 * k, parameters);
  std::vector<WeightedPoint<double>> values;
  for (Eigen::Index i = 0; i < k; ++i) {
    const WeightedPoint<Jet>& m = points[static_cast<std::size_t>(i)];
    d.jacobian.row(i) = m.x.v.head(parameters).transpose();
    d.jacobian.row(k + i) = m.y.v.head(parameters).transpose();
    d.jacobian.row(2 * k + i) = m.z.v.head(parameters).transpose();
    d.jacobian.row(3 * k + i) = m.weight.v.head(parameters).transpose() / m.weight.a;
    values.push_back({m.x.a, m.y.a, m.z.a, m.weight.a});
  }
  fill(d, values);
}
}  // namespace

Density density_of(const GeometricModel& model, const Counts& counts, const Pose& data_from_model,
                   const Eigen::VectorXd& theta, bool derivatives) {
  Density d;
  const auto n = static_cast<std::size_t>(theta.size());
  d.width = theta[kWidth], d.background = theta[kBackground];
  if (derivatives) {
    std::vector<Jet> t(n);
    for (std::size_t i = 0; i < n; ++i) t[i] = Jet(theta[static_cast<Eigen::Index>(i)], static_cast<int>(i));
    fill(d, placed(model, counts, data_from_model, t), theta.size());
  } else {
    fill(d, placed(model, counts, data_from_model, std::vector<double>(theta.data(), theta.data() + n)));
  }
  return d;
}

GroupScores group_scores(const FitData& data, const Density& density) {
  const Eigen::Index parameters = density.jacobian.cols();
  GroupScores out;
  out.log_density = Eigen::VectorXd::Zero(data.groups);
  if (parameters > 0) out.gradient = Eigen::MatrixXd::Zero(parameters, data.groups);
  std::vector<std::vector<Eigen::Index>> members(static_cast<std::size_t>(data.groups));
  for (std::size_t i = 0; i < data.size(); ++i)
    members[static_cast<std::size_t>(data.group[i])].push_back(static_cast<Eigen::Index>(i));
  parallel_for(members.size(), [&](std::size_t g) {
    if (members[g].empty()) return;
    Localisation localisation(density);
    Eigen::ArrayXd points = Eigen::ArrayXd::Zero(4 * density.x.size());
    double sum = 0, width = 0, background = 0;
    for (const Eigen::Index i : members[g]) {
      sum += localisation.log_density(data.x_nm.col(i), data.covariance_nm2[static_cast<std::size_t>(i)],
                                      data.background_density, data.planar);
      if (parameters > 0) localisation.add_gradient(points, width, background);
    }
    const auto column = static_cast<Eigen::Index>(g);
    out.log_density[column] = sum;
    if (parameters == 0) return;
    out.gradient.col(column) = density.jacobian.transpose() * points.matrix();
    out.gradient(kWidth, column) += width;
    out.gradient(kBackground, column) += background;
  });
  return out;
}

Eigen::VectorXd responsibilities(const FitData& data, const Density& density) {
  constexpr std::size_t kBlock = 512;  // localisations
  const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(density.x.size());
  return ordered_sum(data.size(), kBlock, zero,
                     [&](std::size_t begin, std::size_t end) {
                       Eigen::ArrayXd sum = zero;
                       Localisation localisation(density);
                       for (std::size_t i = begin; i < end; ++i) {
                         localisation.log_density(data.x_nm.col(static_cast<Eigen::Index>(i)),
                                                  data.covariance_nm2[i], data.background_density,
                                                  data.planar);
                         sum += localisation.responsibility();
                       }
                       return sum;
                     })
      .matrix();
}

Eigen::VectorXd log_densities(const FitData& data, const Density& density) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(data.size()));
  Localisation localisation(density);
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = localisation.log_density(data.x_nm.col(i), data.covariance_nm2[static_cast<std::size_t>(i)],
                                      data.background_density, data.planar);
  return out;
}

}  // namespace polar::fitting
