#include "smlm/particle_set.hpp"

#include <limits>

#include "smlm/error.hpp"

namespace smlm {

ParticleSet group_particles(LocalisationTable table) {
  if (table.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(Fault::resource, "input.files", "hold more than 2^32 localisations",
                "register them in parts");
  }
  if (table.particle_names.empty()) {
    throw Error(Fault::input, table.files.empty() ? "input.files" : table.files.front(),
                "no column says which localisation belongs to which particle",
                "name it under input.columns.particle, or use input.particles: one_per_file");
  }
  ParticleSet set;
  std::vector<std::uint32_t> sizes(table.particle_names.size(), 0);
  for (const std::int64_t particle : table.particle) {
    if (particle >= 0) ++sizes[static_cast<std::size_t>(particle)];
  }
  set.particles.resize(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    set.particles[i].name = table.particle_names[i];
    set.particles[i].rows.reserve(sizes[i]);
  }
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    set.particles[static_cast<std::size_t>(table.particle[row])].rows.push_back(
        static_cast<std::uint32_t>(row));
  }
  set.table = std::move(table);
  return set;
}

}  // namespace smlm
