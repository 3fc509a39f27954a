#include "polar/simulation/simulate.hpp"

#include <cmath>
#include <utility>

#include "particle.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/simulation/cramer_rao.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kFrameStage = 0x61;
constexpr std::uint64_t kFrames = 20000;
constexpr double kPsf_nm = 130;  // sigma = psf / sqrt(photons), the leading term of the localisation error
// Draws a localisation for the Fisher information: more where sites are few and sums are cheap.
constexpr Eigen::Index kFewSites = 256;
constexpr int kManyDraws = 8, kFewDraws = 1;

Structure projected(Structure s, bool planar) {
  if (planar) s.site_nm.row(2).setZero();
  return s;
}

Eigen::Matrix<double, 6, 6> bound(const simulation::ParticleDraw& particle, const SimulationOptions& o,
                                  double radius_nm, std::uint64_t index) {
  StructureModel model;
  model.site_nm = particle.visible_site_nm;
  model.label_size_nm = o.label_size_nm;
  model.outlier_fraction = o.outlier_fraction;
  const double ball = simulation::kOutlierBall * radius_nm;
  model.outlier_density = o.planar ? 1 / (kPi * ball * ball) : 3 / (4 * kPi * ball * ball * ball);
  model.planar = o.planar;
  const int draws = model.site_nm.cols() <= kFewSites ? kManyDraws : kFewDraws;
  return cramer_rao_bound(
      fisher_information(model, particle.structure_from_view, particle.covariance_nm2, draws, o.seed, index),
      o.planar);
}

void append(Simulation& out, const simulation::ParticleDraw& particle, const SimulationOptions& o,
            std::size_t index) {
  smlm::LocalisationTable& table = out.table;
  KeyedRandom random(o.seed, index, kFrameStage);
  for (std::size_t i = 0; i < particle.position_nm.size(); ++i) {
    const Eigen::Vector3d& x = particle.position_nm[i];
    table.position_nm.push_back({x.x(), x.y(), x.z()});
    table.covariance_nm2.push_back(particle.covariance_nm2[i]);
    table.particle.push_back(static_cast<std::int64_t>(index));
    table.source_file.push_back(0);
    table.source_row.push_back(table.size());
    out.is_outlier.push_back(i >= particle.n_structure ? 1 : 0);
    table.extra[0].values.push_back(static_cast<double>(random.below(kFrames)));
    table.extra[1].values.push_back(std::round(kPsf_nm * kPsf_nm / double(particle.covariance_nm2[i][0])));
    table.extra[2].values.push_back(out.is_outlier.back());
  }
}
}  // namespace

Simulation simulate(const Structure& structure, const SimulationOptions& o) {
  smlm::throw_if_any(violations(o), smlm::Fault::usage, "");
  if (structure.site_nm.cols() == 0)
    throw smlm::Error(smlm::Fault::input, structure.name, "the structure has no sites");
  const Structure s = projected(structure, o.planar);
  const auto n = static_cast<std::size_t>(o.particles);
  Simulation out;
  out.table.planar = o.planar;
  out.table.files = out.table.formats = {"simulated"};
  for (const auto& [name, unit] : {std::pair{"frame", ""}, {"intensity", "photon"}, {"is_outlier", ""}}) {
    out.table.extra.emplace_back();
    out.table.extra.back().name = name;
    out.table.extra.back().unit = unit;
  }
  out.particle.resize(n);
  std::vector<simulation::ParticleDraw> drawn(n);
  parallel_for(n, [&](std::size_t i) {
    drawn[i] = simulation::draw_particle(s, o, i);
    out.particle[i].structure_from_view = drawn[i].structure_from_view;
    out.particle[i].visibility = drawn[i].visibility;
    out.particle[i].radius_change_nm = drawn[i].radius_change_nm;
    out.particle[i].height_change_nm = drawn[i].height_change_nm;
    if (o.cramer_rao) out.particle[i].covariance = bound(drawn[i], o, s.radius_nm(), i);
  });
  for (std::size_t i = 0; i < n; ++i) {
    out.table.particle_names.push_back(
        std::to_string(i + 1));  // numbers: what every program's group column holds
    append(out, drawn[i], o, i);
  }
  return out;
}

}  // namespace polar
