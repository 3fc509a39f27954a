#include "polar/fitting/fit_data.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "registration/data/bursts.hpp"

namespace polar::fitting {

namespace {
constexpr std::uint32_t kBurstStage = 0xf1;
constexpr double kBoxMargin = 3;             // standard deviations about the outermost localisations
constexpr double kLeastVariance_nm2 = 1e-4;  // of a table that claims to know more

double log_box(const FitData& d) {
  double log_volume = 0;
  for (int axis = 0; axis < (d.planar ? 2 : 3); ++axis) {
    std::vector<double> sigma;
    for (const Eigen::Matrix3d& c : d.covariance_nm2) sigma.push_back(std::sqrt(c(axis, axis)));
    log_volume += std::log(d.x_nm.row(axis).maxCoeff() - d.x_nm.row(axis).minCoeff() +
                           2 * kBoxMargin * quantile(std::move(sigma), 0.5));
  }
  return log_volume;
}

void find_bursts(FitData& d, double distance, std::uint64_t seed, std::uint64_t item) {
  View view;
  const Eigen::Vector3d centre = d.centre_nm();
  view.points = (d.x_nm.colwise() - centre).cast<float>();
  for (const Eigen::Matrix3d& c : d.covariance_nm2) view.covariance.push_back(symmetric3(c));
  d.group = bursts(view, random_order(d.size(), KeyedRandom(seed, item, kBurstStage)), distance, d.planar);
  d.groups = 0;
  for (const int g : d.group) d.groups = std::max(d.groups, g + 1);
  for (int& g : d.group)
    if (g < 0) g = d.groups++;  // beyond the bursts that were looked for: one of its own
}
}  // namespace

Eigen::Vector3d FitData::centre_nm() const {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> along(size());
    for (std::size_t i = 0; i < size(); ++i) along[i] = x_nm(axis, static_cast<Eigen::Index>(i));
    centre[axis] = quantile(std::move(along), 0.5);
  }
  return centre;
}

double FitData::extent_nm() const {
  const Eigen::VectorXd distance = (x_nm.colwise() - centre_nm()).colwise().norm();
  return quantile({distance.data(), distance.data() + distance.size()}, 0.5);
}

std::vector<FitData> particles_of(const smlm::LocalisationTable& table, double burst_distance,
                                  std::uint64_t seed) {
  std::vector<std::vector<std::size_t>> rows(table.particle_names.size());
  for (std::size_t i = 0; i < table.size(); ++i)
    if (table.particle[i] >= 0) rows[static_cast<std::size_t>(table.particle[i])].push_back(i);
  std::vector<FitData> out(rows.size());
  parallel_for(rows.size(), [&](std::size_t p) {
    FitData& d = out[p];
    d.planar = table.planar;
    d.x_nm.resize(3, static_cast<Eigen::Index>(rows[p].size()));
    for (std::size_t i = 0; i < rows[p].size(); ++i) {
      const auto& x = table.position_nm[rows[p][i]];
      d.x_nm.col(static_cast<Eigen::Index>(i)) << x[0], x[1], table.planar ? 0.0 : x[2];
      Eigen::Matrix3d c = matrix(table.covariance_nm2[rows[p][i]]);
      c.diagonal().array() += kLeastVariance_nm2;
      d.covariance_nm2.push_back(c);
    }
    if (d.size() > 0) find_bursts(d, burst_distance, seed, p);
  });
  double largest = -INFINITY;
  for (const FitData& d : out)
    if (d.size() > 0) largest = std::max(largest, log_box(d));
  for (FitData& d : out) d.background_density = std::exp(-largest);
  return out;
}

FitData superparticle_of(const std::vector<FitData>& particles) {
  FitData all;
  std::size_t n = 0;
  for (const FitData& d : particles) n += d.size();
  all.x_nm.resize(3, static_cast<Eigen::Index>(n));
  Eigen::Index at = 0;
  for (const FitData& d : particles) {
    if (d.size() == 0) continue;
    all.planar = d.planar, all.background_density = d.background_density;
    all.x_nm.middleCols(at, d.x_nm.cols()) = d.x_nm;
    at += d.x_nm.cols();
    all.covariance_nm2.insert(all.covariance_nm2.end(), d.covariance_nm2.begin(), d.covariance_nm2.end());
    all.group.insert(all.group.end(), d.size(), all.groups++);
  }
  return all;
}

FitData some_of(const FitData& data, const std::vector<std::uint32_t>& which) {
  FitData some;
  some.planar = data.planar, some.background_density = data.background_density, some.groups = data.groups;
  some.x_nm.resize(3, static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) {
    some.x_nm.col(static_cast<Eigen::Index>(i)) = data.x_nm.col(which[i]);
    some.covariance_nm2.push_back(data.covariance_nm2[which[i]]);
    some.group.push_back(data.group[which[i]]);
  }
  return some;
}

}  // namespace polar::fitting
