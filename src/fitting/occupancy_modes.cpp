#include "occupancy_modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "polar/core/rng.hpp"

namespace polar::fitting {

namespace {
constexpr std::uint32_t kIndependentStage = 0xf7;

// Eigenvalues of the covariance of occupancies over particles, the largest first, and their vectors.
struct Components {
  Eigen::VectorXd variance;
  Eigen::MatrixXd vector;
};

Components components(const Eigen::MatrixXd& occupied) {  // sites x particles
  const Eigen::MatrixXd d = occupied.colwise() - occupied.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(d * d.transpose() /
                                                             static_cast<double>(occupied.cols()));
  return {eigen.eigenvalues().reverse(), eigen.eigenvectors().rowwise().reverse()};
}

Eigen::MatrixXd independent(const Eigen::VectorXd& occupancy, Eigen::Index particles, std::uint64_t seed,
                            std::uint64_t draw) {
  KeyedRandom random(seed, draw, kIndependentStage);
  Eigen::MatrixXd drawn(occupancy.size(), particles);
  for (Eigen::Index p = 0; p < particles; ++p)
    for (Eigen::Index k = 0; k < occupancy.size(); ++k) drawn(k, p) = random.uniform() < occupancy[k] ? 1 : 0;
  return drawn;
}
}  // namespace

void add_occupancy_modes(ModesReport& report, const std::vector<std::vector<Label>>& labels,
                         const ModesOptions& o) {
  const Eigen::Index sites = report.site_nm.cols();
  std::vector<std::size_t> shown;  // particles with a label
  for (std::size_t p = 0; p < labels.size(); ++p)
    if (!labels[p].empty()) shown.push_back(p);
  const auto particles = static_cast<Eigen::Index>(shown.size());
  Eigen::MatrixXd occupied = Eigen::MatrixXd::Zero(sites, particles);
  for (Eigen::Index p = 0; p < particles; ++p)
    for (const Label& l : labels[shown[static_cast<std::size_t>(p)]]) occupied(l.site, p) = 1;
  report.occupancy = occupied.rowwise().mean();
  const Components found = components(occupied);
  const auto count = std::min<Eigen::Index>(o.modes, sites);
  double control = 0;
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(sites);  // mean over draws
  for (int draw = 0; draw < o.draws; ++draw) {
    const Components c =
        components(independent(report.occupancy, particles, o.seed, static_cast<std::uint64_t>(draw)));
    control = std::max(control, c.variance[0]);
    noise += c.variance / o.draws;
  }
  const Eigen::MatrixXd centred = occupied.colwise() - report.occupancy;
  for (Eigen::Index m = 0; m < count; ++m) {
    Mode mode;
    const double sd = std::sqrt(std::max(found.variance[m], 1e-12));
    mode.field = sd * found.vector.col(m).transpose();
    mode.variance = found.variance[m] / static_cast<double>(sites);
    mode.control = control / static_cast<double>(sites);
    mode.above_noise = mode.variance > mode.control;
    // Of the scores' variance, chance explains as much as it does without a mode.
    const double chance = std::min(1.0, noise[m] / std::max(found.variance[m], 1e-12));
    mode.reliability = std::sqrt(1 - chance);
    mode.score = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(labels.size()), NAN),
    mode.score_std = mode.score;
    const Eigen::VectorXd score = centred.transpose() * found.vector.col(m) / sd;
    for (Eigen::Index p = 0; p < particles; ++p) {
      const auto row = static_cast<Eigen::Index>(shown[static_cast<std::size_t>(p)]);
      mode.score[row] = score[p], mode.score_std[row] = std::sqrt(chance);
    }
    report.occupancy_mode.push_back(mode);
  }
  share_among(report.occupancy_mode);
}

}  // namespace polar::fitting
