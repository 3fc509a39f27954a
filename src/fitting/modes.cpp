#include "polar/fitting/modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "factor_model.hpp"
#include "halves.hpp"
#include "occupancy_modes.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "registration/data/evidence.hpp"

namespace polar::fitting {

namespace {
constexpr int kRounds = 3;                 // of sharing out and fitting
constexpr int kSharings = 3;               // of a particle's localisations, see labels_at
constexpr double kPriorLocalisations = 1;  // that speak for a site's usual weight
constexpr double kStartVariance_nm2 = 9;
constexpr double kLeastBackground = 1e-4, kStartBackground = 0.05;
constexpr std::uint32_t kMirrorStage = 0xf5, kHalfStage = 0xf6;

struct Analysis {
  Structure structure;
  FactorModel model;
  std::vector<std::vector<Label>> labels;  // of every particle
};

// As the factors have them, every site with a label or not.
Places expected_places(const Analysis& a, const Factors& f) {
  Places places{a.structure.site_nm + displacement_of(a.model, f), spread_of(a.model, f), a.structure.weight};
  for (Eigen::Matrix3d& spread : places.spread_nm2) spread.diagonal().array() += a.structure.variance_nm2;
  return places;
}

// Localisations are shared out again and again to labels as they come out: those of one label are one
// label's. `shared`: how, at last.
std::vector<Label> labels_at(const Analysis& a, const FitData& data, Sharing* shared = nullptr) {
  Factors f;
  f.mean = Eigen::VectorXd::Zero(a.model.field_nm.cols() + 6);
  f.covariance = Eigen::MatrixXd::Zero(f.mean.size(), f.mean.size());
  Places places = expected_places(a, f);
  std::vector<Label> labels;
  const double n = static_cast<double>(data.size());
  for (int round = 0; round < kSharings; ++round) {
    const Sharing sharing = share_out(data, places, a.structure.background);
    if (shared) *shared = sharing;
    labels = labels_of(data, a.structure, sharing);
    f = factors_of(a.model, labels);
    places = expected_places(a, f);
    places.weight *= kPriorLocalisations / (n + kPriorLocalisations);
    const Eigen::Matrix3Xd moved = displacement_of(a.model, f);
    const double v = a.structure.variance_nm2;
    for (const Label& l : labels) {
      const Eigen::Matrix3d pull = v * (l.covariance_nm2 + v * Eigen::Matrix3d::Identity()).inverse();
      places.x_nm.col(l.site) += pull * (l.displacement_nm - moved.col(l.site));
      places.spread_nm2[static_cast<std::size_t>(l.site)] -= v * pull;
      places.weight[l.site] += (1 - a.structure.background) * l.localisations / (n + kPriorLocalisations);
    }
  }
  return labels;
}

void renew_weights(Structure& s, const FactorModel& model, const std::vector<FitData>& particles,
                   const std::vector<std::vector<Label>>& labels) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(s.weight.size());
  double total = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (const Label& l : labels[p]) weight[l.site] += l.localisations;
    total += static_cast<double>(particles[p].size());
  }
  s.background = std::max(kLeastBackground, 1 - weight.sum() / total);
  s.weight = weight * (1 - s.background) / weight.sum();
  s.variance_nm2 = model.variance_nm2;
}

Analysis analyse(const std::vector<FitData>& particles, const Eigen::Matrix3Xd& site_nm, int modes,
                 const ModesOptions& o) {
  Analysis a;
  a.structure.site_nm = site_nm;
  a.structure.background = kStartBackground;
  a.structure.variance_nm2 = kStartVariance_nm2;
  a.structure.weight =
      Eigen::VectorXd::Constant(site_nm.cols(), (1 - kStartBackground) / static_cast<double>(site_nm.cols()));
  a.model = rigid_model(site_nm, modes, o.pose_std_deg, o.pose_std_nm, particles.front().planar,
                        kStartVariance_nm2);
  a.labels.resize(particles.size());
  for (int round = 0; round < kRounds; ++round) {
    parallel_for(particles.size(), [&](std::size_t p) { a.labels[p] = labels_at(a, particles[p]); });
    fit_factors(a.model, a.labels);
    renew_weights(a.structure, a.model, particles, a.labels);
    a.structure.site_nm += a.model.mean_nm;  // the means become the sites
    for (auto& own : a.labels)
      for (Label& l : own) l.displacement_nm -= a.model.mean_nm.col(l.site);
    a.model.mean_nm.setZero();
  }
  return a;
}

double mean_square(const Eigen::VectorXd& field) {
  return 3 * field.squaredNorm() / static_cast<double>(field.size());
}

// The same localisations, every label with its localisations mirrored at its expected place or not, by
// chance: as far from what `known` explains as before, and no label knows of another.
std::vector<FitData> mirrored_copy(const std::vector<FitData>& particles, const Analysis& known,
                                   std::uint64_t seed, std::uint64_t draw) {
  std::vector<FitData> copies = particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    KeyedRandom random(seed, p + (draw << 32), kMirrorStage);
    Sharing sharing;
    Factors f = factors_of(known.model, labels_at(known, particles[p], &sharing));
    f.mean.tail<6>().setZero();  // a rigid motion that was found is in part noise, which must stay
    const Eigen::Matrix3Xd place = known.structure.site_nm + displacement_of(known.model, f);
    std::vector<bool> mirrored;
    for (Eigen::Index k = 0; k < place.cols(); ++k) mirrored.push_back(random.uniform() < 0.5);
    for (Eigen::Index i = 0; i < sharing.responsibility.cols(); ++i) {
      double u = random.uniform();
      Eigen::Index site = 0;
      while (site < place.cols() && u >= sharing.responsibility(site, i))
        u -= sharing.responsibility(site++, i);
      if (site == place.cols() || !mirrored[static_cast<std::size_t>(site)]) continue;  // or background
      copies[p].x_nm.col(i) = 2 * place.col(site) - particles[p].x_nm.col(i);
      if (copies[p].planar) copies[p].x_nm(2, i) = 0;
    }
  }
  return copies;
}

// The largest variance that mode number `mode` (from 0) has by chance, where those before it are real.
double control_of(const std::vector<FitData>& particles, const Eigen::Matrix3Xd& site_nm, int mode,
                  const ModesOptions& o) {
  const Analysis known = analyse(particles, site_nm, mode, o);
  std::vector<double> variance(static_cast<std::size_t>(o.draws));
  parallel_for(variance.size(), [&](std::size_t draw) {
    const Analysis null = analyse(mirrored_copy(particles, known, o.seed, draw), site_nm, o.modes, o);
    variance[draw] = mean_square(null.model.field_nm.col(mode));
  });
  return *std::max_element(variance.begin(), variance.end());
}

// Mean log density of the judging localisations of one particle whose factors the others gave.
double judged(const Analysis& a, const FitData& data, std::uint64_t seed, std::uint64_t particle) {
  const Halves halves = halves_of(data, seed, particle);
  if (halves.fitted.size() == 0 || halves.judging.size() == 0) return NAN;
  const Factors f = factors_of(a.model, labels_at(a, halves.fitted));
  return share_out(halves.judging, expected_places(a, f), a.structure.background).log_density.mean();
}

// The others count as scatter of the labels.
Analysis first_modes(Analysis a, Eigen::Index modes) {
  for (Eigen::Index m = modes; m < a.model.field_nm.cols(); ++m)
    a.structure.variance_nm2 += mean_square(a.model.field_nm.col(m)) / 3;
  a.model.variance_nm2 = a.structure.variance_nm2;
  a.model.field_nm.conservativeResize(Eigen::NoChange, modes);
  return a;
}

// One evidence a number of modes, from 0: everything common is fitted to the other half of the particles.
std::vector<Evidence> evidences(const std::vector<FitData>& particles, const Eigen::Matrix3Xd& site_nm,
                                const ModesOptions& o) {
  const auto order = random_order(particles.size(), KeyedRandom(o.seed, 0, kHalfStage));
  std::vector<Evidence> out(static_cast<std::size_t>(o.modes) + 1, Evidence(particles.size(), NAN));
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<FitData> others;
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < order.size(); ++i)
      if (i % 2 == half)
        own.push_back(order[i]);
      else
        others.push_back(particles[order[i]]);
    if (others.empty()) continue;
    const Analysis whole = analyse(others, site_nm, o.modes, o);
    for (std::size_t modes = 0; modes < out.size(); ++modes) {
      const Analysis a = first_modes(whole, static_cast<Eigen::Index>(modes));
      parallel_for(own.size(),
                   [&](std::size_t k) { out[modes][own[k]] = judged(a, particles[own[k]], o.seed, own[k]); });
    }
  }
  return out;
}

// Share of a field in the direction of one motion of all sites.
double share_along(const Eigen::VectorXd& field, const Eigen::VectorXd& motion) {
  const double n = field.squaredNorm() * motion.squaredNorm();
  return n > 0 ? std::pow(field.dot(motion), 2) / n : 0;
}

void describe(Mode& mode, const Eigen::VectorXd& field, const Eigen::Matrix3Xd& site_nm) {
  const Eigen::Vector3d centre = site_nm.rowwise().mean();
  Eigen::VectorXd radial = Eigen::VectorXd::Zero(field.size()), axial = radial;
  for (Eigen::Index k = 0; k < site_nm.cols(); ++k) {
    Eigen::Vector3d outward = site_nm.col(k) - centre;
    axial[3 * k + 2] = outward.z();
    outward.z() = 0;
    radial.segment<3>(3 * k) = outward.normalized();
  }
  mode.radial = share_along(field, radial), mode.axial = share_along(field, axial);
}

std::vector<Mode> modes_of(const Analysis& a, std::size_t particles) {
  std::vector<Mode> modes;
  for (Eigen::Index m = 0; m < a.model.field_nm.cols(); ++m) {
    Mode mode;
    Eigen::VectorXd field = a.model.field_nm.col(m);
    describe(mode, field, a.structure.site_nm);
    mode.field = Eigen::Map<const Eigen::MatrixXd>(field.data(), 3, field.size() / 3);
    mode.variance = mean_square(field);
    mode.score = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(particles), NAN),
    mode.score_std = mode.score;
    modes.push_back(mode);
  }
  std::vector<double> uncertain(modes.size(), 0.0);
  double n = 0;
  for (std::size_t p = 0; p < particles; ++p) {
    if (a.labels[p].empty()) continue;
    const Factors f = factors_of(a.model, a.labels[p]);
    ++n;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const auto i = static_cast<Eigen::Index>(m), row = static_cast<Eigen::Index>(p);
      modes[m].score[row] = f.mean[i];
      modes[m].score_std[row] = std::sqrt(f.covariance(i, i));
      uncertain[m] += f.covariance(i, i);
    }
  }
  for (std::size_t m = 0; m < modes.size(); ++m)
    modes[m].reliability = std::sqrt(std::max(0.0, 1 - uncertain[m] / std::max(1.0, n)));
  return modes;
}
}  // namespace

std::vector<std::string> violations(const ModesOptions& o) {
  std::vector<std::string> faults;
  const auto require = [&](bool holds, const char* sentence) {
    if (!holds) faults.emplace_back(sentence);
  };
  require(o.modes >= 1 && o.modes <= kMostModes, "modes must be 1 to 20");
  require(o.draws >= 1 && o.draws <= 1000, "draws must be 1 to 1000");
  require(o.pose_std_deg > 0 && o.pose_std_deg <= 180, "pose_std_deg must be above 0, at most 180");
  require(o.pose_std_nm > 0 && o.pose_std_nm <= 1e6, "pose_std_nm must be above 0, at most a million");
  require(o.burst_distance >= 0 && o.burst_distance <= 100, "burst_distance must be 0 to 100");
  return faults;
}

void share_among(std::vector<Mode>& modes) {
  double above = 0;
  for (const Mode& m : modes) above += m.above_noise ? m.variance - m.control : 0;
  for (Mode& m : modes) m.share = m.above_noise ? (m.variance - m.control) / above : 0;
}

ModesReport find_modes(const std::vector<FitData>& particles, const Eigen::Matrix3Xd& site_nm,
                       const ModesOptions& o) {
  const Analysis found = analyse(particles, site_nm, o.modes, o);
  ModesReport report;
  report.site_nm = found.structure.site_nm;
  report.width_nm = std::sqrt(found.structure.variance_nm2);
  report.background = found.structure.background;
  report.position = modes_of(found, particles.size());
  const std::vector<Evidence> evidence = evidences(particles, site_nm, o);
  for (std::size_t m = 0; m < report.position.size(); ++m) {
    Mode& mode = report.position[m];
    const Comparison c = compare(evidence[m], evidence[m + 1]);
    mode.gain = c.gain, mode.gain_std = c.standard_error;
    // After one that is not above noise, none is: what it was held against stays.
    const bool last_is_real = m == 0 || report.position[m - 1].above_noise;
    mode.control = last_is_real ? control_of(particles, site_nm, static_cast<int>(m), o)
                                : report.position[m - 1].control;
    mode.above_noise = last_is_real && mode.variance > mode.control && mode.gain > 0;
  }
  share_among(report.position);
  add_occupancy_modes(report, found.labels, o);
  return report;
}

}  // namespace polar::fitting
