// A record as a perfect run of simulated nuclear pores leaves it.
#pragma once

#include "polar/report/record.hpp"
#include "polar/results/result_file.hpp"
#include "report/section.hpp"
#include "support/fake_results.hpp"
#include "support/temporary_directory.hpp"

namespace polar::report {

inline Results pores(std::size_t particles, const SimulationOptions& base = {}) {
  const Structure pore = make_structure({});
  SimulationOptions o = base;
  o.particles = static_cast<int>(particles);
  o.label_size_nm = 0;
  o.sigma_xy_nm = {2, 4};
  o.cramer_rao = false;
  return support::perfect_results(simulate(pore, o), pore);
}

inline RunRecord through_file(const Results& results) {
  const support::TemporaryDirectory directory;
  write_result_file(directory.path("results.h5"), results, superparticle(results));
  return read_run_record(directory.path("results.h5"));
}

/// The figure of that id; fails the test where there is none.
inline Figure figure(const Section& section, const std::string& id) {
  for (const Figure& f : section.figures)
    if (f.id == id) return f;
  ADD_FAILURE() << "no figure " << id << " in " << section.id;
  return {};
}

}  // namespace polar::report
