// One reader on arbitrary bytes: it may refuse them with an smlm::Error, and whatever it accepts must be a
// sound table, with every HDF5 handle closed. POLAR_FUZZ_FORMAT is the reader's name, or "auto".
#include <cmath>

#include "hdf5_handles.hpp"
#include "input_file.hpp"
#include "smlm/error.hpp"
#include "smlm/inspect.hpp"
#include "smlm/table_reader.hpp"

namespace {

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  smlm::ReadOptions options;
  options.format = POLAR_FUZZ_FORMAT;
  options.pixel_size_nm = 100;
  for (const bool drop : {false, true}) {
    options.drop_nonfinite = drop;
    try {
      // Not read_tables(): it would first try in another process, where nothing is seen.
      const std::string path = input_file(data, size, ".input");
      check(smlm::find_reader(smlm::read_head(path), options).read(path, options));
    } catch (const smlm::Error&) {
    }
    require(open_handles() == 0);
  }
  return 0;
}
