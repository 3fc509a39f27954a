// One reader on arbitrary bytes: it may refuse them with an smlm::Error, and whatever it accepts must be a
// sound table, with every HDF5 handle closed. POLAR_FUZZ_FORMAT is the reader's name, or "auto".
#include <hdf5.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "smlm/error.hpp"
#include "smlm/inspect.hpp"
#include "smlm/table_reader.hpp"

namespace {

std::string write_input(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/dev/shm/polar_fuzz_" + std::to_string(::getpid()) + ".input";
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(data, 1, size, file) != size) std::abort();
  std::fclose(file);
  return path;
}

void require(bool sound) {
  if (!sound) std::abort();
}

void check(const smlm::LocalisationTable& table) {
  const std::size_t n = table.size();
  require(table.covariance_nm2.size() == n && table.particle.size() == n && table.source_row.size() == n);
  for (const smlm::ExtraColumn& extra : table.extra) require(extra.values.size() == n);
  for (std::size_t row = 0; row < n; ++row) {
    for (const double x : table.position_nm[row]) require(std::isfinite(x));
    const smlm::Covariance& c = table.covariance_nm2[row];
    require(c[0] > 0 && c[3] > 0 && c[5] > 0);
    require(table.particle[row] >= -1 &&
            table.particle[row] < static_cast<std::int64_t>(table.particle_names.size()));
  }
  require(!smlm::to_json(smlm::inspect(table)).empty());
}

// Of ours; the library keeps handles of its own types.
hsize_t open_handles() {
  hsize_t all = 0;
  for (const H5I_type_t type : {H5I_FILE, H5I_GROUP, H5I_DATASET, H5I_DATASPACE, H5I_ATTR}) {
    hsize_t count = 0;
    if (H5Inmembers(type, &count) >= 0) all += count;
  }
  return all;
}

}  // namespace

// HDF5 1.10 loses memory of its own where it gives up on a damaged file: that is why such files are first
// read in another process. Whether we lose its handles is tested below.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  smlm::ReadOptions options;
  options.format = POLAR_FUZZ_FORMAT;
  options.pixel_size_nm = 100;
  for (const bool drop : {false, true}) {
    options.drop_nonfinite = drop;
    try {
      // Not read_tables(): it would first try in another process, where nothing is seen.
      const std::string path = write_input(data, size);
      check(smlm::find_reader(smlm::read_head(path), options).read(path, options));
    } catch (const smlm::Error&) {
    }
    require(open_handles() == 0);
  }
  return 0;
}
