#include "known_template.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kScrambledStage = 30;
constexpr std::uint64_t kPosedKey = 6000;
constexpr double kWholeMass = 1e8;  // of all sites, as counts

// Every localisation turned about its particle's centre: the distances from it stay, nothing else does.
Views scrambled(const Problem& problem, const std::vector<int>& which) {
  Views out = problem.views;
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    KeyedRandom random(problem.seed, i, kScrambledStage);
    Eigen::Matrix3Xf& x = out.view[i].points;
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      const Eigen::Matrix3d turn =
          problem.planar() ? so3_exp({0, 0, kTwoPi * random.uniform()}) : random.rotation();
      x.col(j) = turn.cast<float>() * x.col(j);
    }
  });
  return out;
}

// Each voxel without the mean of its shell about `centre`.
std::vector<double> without_shells(const DensityGrid& density, const Eigen::Vector3f& centre) {
  const std::vector<float>& value = density.value();
  std::vector<std::size_t> shell(value.size());
  std::vector<double> sum, count;
  for (std::size_t v = 0; v < value.size(); ++v) {
    shell[v] = static_cast<std::size_t>((density.position(v) - centre).norm() / density.frame().voxel);
    if (shell[v] >= sum.size()) sum.resize(shell[v] + 1, 0.0), count.resize(shell[v] + 1, 0.0);
    sum[shell[v]] += static_cast<double>(value[v]), ++count[shell[v]];
  }
  std::vector<double> out(value.size());
  for (std::size_t v = 0; v < value.size(); ++v)
    out[v] = static_cast<double>(value[v]) - sum[shell[v]] / count[shell[v]];
  return out;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t v = 0; v < a.size(); ++v) ab += a[v] * b[v], aa += a[v] * a[v], bb += b[v] * b[v];
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Of the template and what these views give when they are posed on it once.
double posed_correlation(const Problem& problem, const std::vector<int>& which,
                         const RegistrationOptions& options) {
  const AnnealOptions& o = options.engine.anneal;
  const SoftAnnealer annealer(problem, which, o, prior_of(options));
  SoftState state =
      known_state(options.known, annealer.frame(), problem, o.last_width, o.first_outlier_fraction);
  const Eigen::Vector3f centre = state.density.centroid().cast<float>();
  const std::vector<double> known = without_shells(state.density, centre);
  annealer.continue_under({1, o.last_width, o.last_width, o.last_beta, o.last_beta, 1, false}, kPosedKey,
                          state);
  return correlation(known, without_shells(state.density, centre));
}

}  // namespace

DensityGrid density_of(const KnownTemplate& known, const VoxelFrame& frame, double scale_nm, double width) {
  const Eigen::Map<const Eigen::VectorXd> weight(known.weight.data(),
                                                 static_cast<Eigen::Index>(known.weight.size()));
  const double total = weight.sum();
  const Eigen::Vector3d centre = known.site_nm * weight / total;
  VoxelCounts counts(frame);
  for (Eigen::Index k = 0; k < known.site_nm.cols(); ++k) {
    Eigen::Vector3f x = ((known.site_nm.col(k) - centre) / scale_nm).cast<float>();
    if (frame.planar()) x.z() = 0;
    LookupPoints site;
    site.add(x);
    site.pad();
    counts.add(site, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(),
               static_cast<std::uint32_t>(std::lround(kWholeMass * weight[k] / total)));
  }
  DensityGrid density(counts);
  density.blur(width);
  density.normalise();
  return density;
}

SoftState known_state(const KnownTemplate& known, const VoxelFrame& frame, const Problem& problem,
                      double width, double outlier_fraction) {
  SoftState state(frame);
  state.density = density_of(known, frame, problem.views.normalisation.scale_nm, width);
  state.width = width;
  state.outlier_fraction = outlier_fraction;
  state.sample.resize(problem.size());
  state.best.resize(problem.size());
  return state;
}

double Likeness::own_share() const { return particles > 0 ? std::clamp(noise / particles, 0.0, 1.0) : 1; }

Likeness likeness_to_known(const Problem& problem, const std::vector<int>& which,
                           const RegistrationOptions& options) {
  const Views views = scrambled(problem, which);
  const Problems noise = make_problems(views, options.engine.evidence, problem.seed);
  return {posed_correlation(problem, which, options), posed_correlation(noise.plain, which, options)};
}

std::string warning_of(const Likeness& likeness) {
  char text[300];
  std::snprintf(
      text, sizeof text,
      "registration.template: up to %.0f %% of the average's likeness to the template could be the "
      "template's own: posed on it, the particles correlate with it by %.2f, noise made of them by %.2f",
      100 * likeness.own_share(), likeness.particles, likeness.noise);
  return text;
}

}  // namespace polar
