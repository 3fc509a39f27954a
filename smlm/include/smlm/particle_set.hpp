// Particles: which rows of a table belong to one copy of the structure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

struct Particle {
  std::string name;                 // as in the input
  std::vector<std::uint32_t> rows;  // indices into the table, ascending
};

struct ParticleSet {
  LocalisationTable table;
  std::vector<Particle> particles;  // in the order of the input
};

/// Groups the rows of `table` by particle; rows without a particle belong to none.
ParticleSet group_particles(LocalisationTable table);

}  // namespace smlm
