// The same measurement twice: rows, particles and files that are equal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

struct Repetitions {
  std::uint64_t rows = 0;        // that equal an earlier one of their particle in everything that is kept
  std::uint64_t particles = 0;   // that are an earlier particle again
  std::string example_row;       // the particle of the first repeated row
  std::string example_particle;  // "'b:1' is 'a:1' again"
  std::vector<std::uint32_t>
      original;  // of each particle of the table: itself, or the earlier one that it is again
};

/// Two particles are one where at least half of a sample of the distinct localisations of either (position
/// and uncertainty, bit for bit) is also in the other's: a copy from which rows were dropped is still a copy.
Repetitions find_repetitions(const LocalisationTable& table);

/// One sentence each for what find_repetitions() counts.
std::vector<std::string> describe(const Repetitions& repetitions);

/// Hash of what a file holds, after unpacking where it is gzip-compressed.
std::uint64_t content_hash(const std::string& path);

}  // namespace smlm
