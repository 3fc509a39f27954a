// report.html: a run to look at, in one file that needs no network.
#pragma once

#include <string>

#include "polar/report/record.hpp"

namespace polar {

/// The page. `name` is its title. The same bits for the same record and any number of threads.
std::string report_page(const RunRecord& record, const std::string& name);

/// Reads the record at `results_h5` and writes its page to `html`, whole or not at all. Throws smlm::Error.
void write_report(const std::string& results_h5, const std::string& html, const std::string& name);

}  // namespace polar
