#include "particle.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar::simulation {

namespace {
// One stream a purpose: more blinks must not change the poses.
enum Stage : std::uint32_t {
  kPoseStage = 0x41,
  kLabelStage,
  kCropStage,
  kOutlierStage,
  kNoiseStage,
  kShapeStage
};

// Strands: a persistent random walk of this many steps, each this share of the radius, turning by this angle.
constexpr int kStrandSteps = 40;
constexpr double kStrandStep = 0.05, kStrandTurn_rad = 0.15;
constexpr int kStrandsPerParticle = 2;

double draw(KeyedRandom& random, const Range& r) { return r[0] + (r[1] - r[0]) * random.uniform(); }

// This copy of the structure: wider and taller than the mean by what it draws.
Structure draw_shape(Structure s, const SimulationOptions& o, std::uint64_t index, ParticleDraw& particle) {
  if (o.radius_std_nm <= 0 && o.height_std_nm <= 0) return s;
  KeyedRandom random(o.seed, index, kShapeStage);
  particle.radius_change_nm = o.radius_std_nm * random.normal();
  particle.height_change_nm = o.height_std_nm * random.normal();
  const double height_nm = s.site_nm.row(2).maxCoeff() - s.site_nm.row(2).minCoeff();
  for (Eigen::Index k = 0; k < s.site_nm.cols(); ++k) {
    const double r = s.site_nm.col(k).head<2>().norm();
    if (r > 0) s.site_nm.col(k).head<2>() *= std::max(0.0, r + particle.radius_change_nm) / r;
    if (height_nm > 0) s.site_nm(2, k) *= std::max(0.0, height_nm + particle.height_change_nm) / height_nm;
  }
  return s;
}

Pose draw_view_from_structure(const SimulationOptions& o, std::uint64_t index) {
  KeyedRandom random(o.seed, index, kPoseStage);
  Pose pose;
  if (o.orientation == "random_so3") pose.rotation = random.rotation();
  if (o.orientation == "in_plane") {
    const Eigen::Vector3d turn(0, 0, 2 * kPi * random.uniform());
    const double tilt = o.tilt_std_deg * kRadiansPerDegree;
    const Eigen::Vector3d tilted(tilt * random.normal(), tilt * random.normal(), 0);
    pose.rotation = so3_exp(tilted) * so3_exp(turn);
  }
  if (o.field_spacing_nm > 0) {
    const auto side = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(o.particles))));
    const std::uint64_t column = index % side, row = index / side;
    pose.translation = o.field_spacing_nm *
                       Eigen::Vector3d(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, 0);
  }
  for (int axis = 0; axis < (o.planar ? 2 : 3); ++axis)
    pose.translation[axis] += o.translation_nm * (2 * random.uniform() - 1);
  return pose;
}

std::uint64_t draw_blinks(KeyedRandom& random, const SimulationOptions& o) {
  if (o.blinks == "fixed") return static_cast<std::uint64_t>(std::llround(o.blinks_mean));
  if (o.blinks == "poisson") return random.poisson(o.blinks_mean);
  if (o.blinks_mean <= 1) return 1;
  return 1 + static_cast<std::uint64_t>(std::log(1 - random.uniform()) / std::log(1 - 1 / o.blinks_mean));
}

// Indices of the sites that the localisations come from, one each.
std::vector<Eigen::Index> draw_labels(const Structure& s, const SimulationOptions& o, KeyedRandom& random) {
  const Eigen::Index sites = s.site_nm.cols();
  std::vector<Eigen::Index> chosen;
  if (o.sampling == "sites") {
    for (Eigen::Index k = 0; k < sites; ++k)
      if (random.uniform() < o.labelling_efficiency) chosen.insert(chosen.end(), draw_blinks(random, o), k);
  } else {
    const auto n = static_cast<std::size_t>(std::llround(draw(random, o.points)));
    std::vector<Eigen::Index> deck;
    while (chosen.size() < n) {  // without repetition until every site was used once
      if (deck.empty()) {
        deck.resize(static_cast<std::size_t>(sites));
        std::iota(deck.begin(), deck.end(), Eigen::Index{0});
      }
      std::swap(deck[random.below(deck.size())], deck.back());
      chosen.push_back(deck.back());
      deck.pop_back();
    }
  }
  // A particle without any localisation would not be in the table: the seen ones have at least one.
  if (chosen.empty())
    chosen.push_back(static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(sites))));
  return chosen;
}

// Keeps the share of points farthest along a random normal, and the sites on that side.
void crop(std::vector<Eigen::Vector3d>& point_nm, ParticleDraw& particle, const Structure& s,
          const SimulationOptions& o, std::uint64_t index) {
  KeyedRandom random(o.seed, index, kCropStage);
  particle.visibility = draw(random, o.visibility);
  particle.visible_site_nm = s.site_nm;
  if (particle.visibility >= 1) return;
  Eigen::Vector3d normal = random.direction();
  if (o.planar) {
    const double angle = 2 * kPi * random.uniform();
    normal = {std::cos(angle), std::sin(angle), 0};
  }
  std::vector<double> along(point_nm.size());
  std::transform(point_nm.begin(), point_nm.end(), along.begin(),
                 [&](const auto& p) { return normal.dot(p); });
  std::vector<double> sorted = along;
  const auto hidden = std::min(
      sorted.size() - 1,
      static_cast<std::size_t>(std::llround((1 - particle.visibility) * static_cast<double>(sorted.size()))));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(hidden), sorted.end());
  const double threshold = sorted[hidden];
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < point_nm.size(); ++i)
    if (along[i] >= threshold) kept.push_back(point_nm[i]);
  point_nm = std::move(kept);
  Eigen::Index n = 0;
  for (Eigen::Index k = 0; k < s.site_nm.cols(); ++k)
    if (normal.dot(s.site_nm.col(k)) >= threshold - 3 * o.label_size_nm)
      particle.visible_site_nm.col(n++) = s.site_nm.col(k);
  particle.visible_site_nm.conservativeResize(3, n);
}

// Outliers in the structure's frame.
std::vector<Eigen::Vector3d> draw_outliers(const Structure& s, const SimulationOptions& o, std::size_t n,
                                           std::uint64_t index) {
  KeyedRandom random(o.seed, index, kOutlierStage);
  const double radius = s.radius_nm();
  std::vector<Eigen::Vector3d> strand;
  if (o.outliers == "strands") {
    for (int curve = 0; curve < kStrandsPerParticle; ++curve) {
      Eigen::Vector3d at = s.site_nm.col(
          static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(s.site_nm.cols()))));
      Eigen::Vector3d heading = at.norm() > 0 ? Eigen::Vector3d(at.normalized()) : random.direction();
      for (int step = 0; step < kStrandSteps; ++step) {
        strand.push_back(at);
        const Eigen::Vector3d turn(random.normal(), random.normal(), random.normal());
        heading = so3_exp(kStrandTurn_rad * turn) * heading;
        at += kStrandStep * radius * heading;
      }
    }
  }
  std::vector<Eigen::Vector3d> outlier(n);
  for (Eigen::Vector3d& x : outlier) {
    if (strand.empty()) {
      const double power = o.planar ? 1.0 / 2 : 1.0 / 3;
      Eigen::Vector3d direction = random.direction();
      if (o.planar) {
        const double angle = 2 * kPi * random.uniform();
        direction = {std::cos(angle), std::sin(angle), 0};
      }
      x = kOutlierBall * radius * std::pow(random.uniform(), power) * direction;
    } else {  // uniform along a curve: between a step and the next one of the same curve
      const auto curve = random.below(kStrandsPerParticle), step = random.below(kStrandSteps - 1);
      const std::size_t at = curve * kStrandSteps + step;
      x = strand[at] + random.uniform() * (strand[at + 1] - strand[at]);
    }
  }
  return outlier;
}

// Turns true positions (structure frame) into localisations with their uncertainty (table frame).
void localise(const std::vector<Eigen::Vector3d>& truth_nm, const SimulationOptions& o, std::uint64_t index,
              ParticleDraw& particle) {
  KeyedRandom random(o.seed, index, kNoiseStage);
  const Pose view_from_structure = particle.structure_from_view.inverse();
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : truth_nm) {
    if (sigma.x() <= 0 || o.sigma_per == "localisation") {
      const double lateral = draw(random, o.sigma_xy_nm);
      sigma = lateral * Eigen::Vector3d(1, draw(random, o.sigma_y_factor), draw(random, o.sigma_z_factor));
    }
    Eigen::Vector3d x = view_from_structure * p;
    for (int axis = 0; axis < 3; ++axis) x[axis] += sigma[axis] * random.normal();
    if (o.planar) x.z() = 0;
    particle.position_nm.push_back(x);
    const Eigen::Vector3f variance = sigma.cwiseAbs2().cast<float>();
    particle.covariance_nm2.push_back({variance.x(), 0, 0, variance.y(), 0, variance.z()});
  }
}
}  // namespace

ParticleDraw draw_particle(const Structure& mean, const SimulationOptions& o, std::uint64_t index) {
  ParticleDraw particle;
  const Structure s = draw_shape(mean, o, index, particle);
  particle.structure_from_view = draw_view_from_structure(o, index).inverse();
  KeyedRandom random(o.seed, index, kLabelStage);
  std::vector<Eigen::Vector3d> truth_nm;
  for (const Eigen::Index k : draw_labels(s, o, random)) {
    Eigen::Vector3d linker(random.normal(), random.normal(), random.normal());
    if (o.planar) linker.z() = 0;
    truth_nm.push_back(s.site_nm.col(k) + o.label_size_nm * linker);
  }
  crop(truth_nm, particle, s, o, index);
  particle.n_structure = truth_nm.size();
  const double odds = o.outlier_fraction / (1 - o.outlier_fraction);
  const auto n_outliers = static_cast<std::size_t>(std::llround(odds * static_cast<double>(truth_nm.size())));
  const std::vector<Eigen::Vector3d> outlier = draw_outliers(s, o, n_outliers, index);
  truth_nm.insert(truth_nm.end(), outlier.begin(), outlier.end());
  localise(truth_nm, o, index, particle);
  return particle;
}

}  // namespace polar::simulation
