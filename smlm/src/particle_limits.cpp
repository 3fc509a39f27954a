#include "smlm/particle_limits.hpp"

#include <cmath>

#include "smlm/number_text.hpp"

namespace smlm {
namespace {

// Below the bounds -1, above them 1; a value that is no number is within.
int side(double value, const Bounds& bounds) { return value < bounds[0] ? -1 : value > bounds[1] ? 1 : 0; }

}  // namespace

std::vector<std::string> violations(const ParticleLimits& limits) {
  std::vector<std::string> faults;
  const std::pair<const char*, const Bounds*> all[] = {{"localisations", &limits.localisations},
                                                       {"radius_nm", &limits.radius_nm}};
  for (const auto& [key, bounds] : all)
    if (!((*bounds)[0] <= (*bounds)[1]))
      faults.push_back(std::string(key) + ": the low bound is above the high one");
  return faults;
}

double radius_nm(const LocalisationTable& table, const std::vector<std::uint32_t>& rows) {
  if (rows.size() < 2) return std::nan("");
  const auto n = static_cast<double>(rows.size());
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double mean = 0;
    for (const std::uint32_t row : rows) mean += table.position_nm[row][axis] / n;
    for (const std::uint32_t row : rows) square += std::pow(table.position_nm[row][axis] - mean, 2);
  }
  return std::sqrt(square / n);
}

std::vector<UnfitParticle> unfit_particles(const ParticleSet& set, const ParticleLimits& limits) {
  std::vector<UnfitParticle> unfit;
  for (std::size_t i = 0; i < set.particles.size(); ++i) {
    const std::vector<std::uint32_t>& rows = set.particles[i].rows;
    const int count = side(static_cast<double>(rows.size()), limits.localisations);
    const int extent = side(radius_nm(set.table, rows), limits.radius_nm);
    if (count != 0)
      unfit.push_back({i, std::string("left out: ") + (count < 0 ? "fewer than " : "more than ") +
                              number_text(limits.localisations[count < 0 ? 0 : 1]) + " localisations"});
    else if (extent != 0)
      unfit.push_back({i, std::string("left out: its radius is ") + (extent < 0 ? "below " : "above ") +
                              number_text(limits.radius_nm[extent < 0 ? 0 : 1]) + " nm"});
  }
  return unfit;
}

}  // namespace smlm
