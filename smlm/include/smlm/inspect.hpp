// What a table holds, in numbers: for a person who wonders whether it was read as it was meant.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

/// Quantiles are over finite values; NaN where there are none.
struct Summary {
  double minimum = 0, median = 0, maximum = 0;
};

struct ColumnSummary {
  std::string name;
  std::string unit;
  bool used = false;         // by the engine; else it is only kept
  std::uint64_t values = 0;  // finite ones
  Summary summary;
};

struct Inspection {
  std::vector<std::string> files, formats;
  std::uint64_t localisations = 0;
  std::uint64_t unassigned = 0;  // localisations of no particle
  std::uint64_t particles = 0;
  Summary localisations_per_particle;
  Summary particle_radius_nm;  // root mean square distance from the particle's centroid
  Summary sigma_lateral_nm, sigma_axial_nm;
  bool planar = false, axial_sigma_assumed = false, sigma_assumed = false;
  std::vector<ColumnSummary> columns;
  std::vector<std::string> mapping;
  std::vector<Rejection> rejected;
  std::vector<std::string> warnings;
  std::string obstacle;  // why nothing could be registered; empty: it can
};

Inspection inspect(const LocalisationTable& table);

/// Aligned lines for a terminal.
std::string to_text(const Inspection& inspection);
/// One JSON object with the fields of Inspection; NaN becomes null, invalid UTF-8 is replaced.
std::string to_json(const Inspection& inspection);

/// Warnings about numbers that hint at a wrong unit or a wrong column, with the column and its unit:
/// uncertainties as large as the width of a PSF or as the particles, or below any microscope's; particles
/// below a nanometre or beyond ten micrometres, of one file far larger than those of another, far deeper than
/// wide; and single particles far larger than the rest. Part of the warnings that read_tables() gives.
std::vector<std::string> implausibilities(const LocalisationTable& table);

}  // namespace smlm
