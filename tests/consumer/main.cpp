// Reads a table, prepares its particles, and says which program it is linked to.
#include <cstdio>

#include "polar/core/sha256.hpp"
#include "polar/pipeline/version.hpp"
#include "polar/registration/prepare.hpp"
#include "smlm/particle_set.hpp"
#include "smlm/table_reader.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const smlm::LocalisationTable table = smlm::read_tables({argv[1]}, {});
  std::printf("%s\n%zu localisations\n%s\n", polar::program_version().c_str(), table.size(),
              polar::sha256("abc", 3).c_str());
  return 0;
}
