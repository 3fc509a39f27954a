// results.h5 on arbitrary bytes, and what `polar export` and `polar report` make of a record that was
// accepted.
#include "hdf5_handles.hpp"
#include "input_file.hpp"
#include "polar/report/page.hpp"
#include "polar/results/result_file.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/thunderstorm.hpp"
#include "smlm/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string file = input_file(data, size, ".h5");
    const polar::ResultRecord record = polar::read_result_file(file);
    require(!polar::format_table_csv(record.superparticle).empty());
    require(!polar::format_thunderstorm_csv(record.superparticle).empty());
    require(!polar::report_page(polar::read_run_record(file), "fuzz").empty());
  } catch (const smlm::Error&) {
  }
  require(open_handles() == 0);
  return 0;
}
