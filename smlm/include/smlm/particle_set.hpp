// Particles: which rows of a table belong to one copy of the structure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "smlm/error.hpp"
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

/// Why the table cannot be registered, with what is known about where its rows went; nothing where it can.
std::optional<Error> obstacle_to_registration(const LocalisationTable& table);

/// Groups the rows of `table` by particle; rows without a particle belong to none.
ParticleSet group_particles(LocalisationTable table);

}  // namespace smlm
