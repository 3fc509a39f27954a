// The files of a result directory, and which of them a format stands for.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// Formats that can be made from the superparticle alone, by a run or later by `polar export`.
std::vector<std::string> export_formats();

/// Writes the files of one of export_formats() into `directory`; returns their names.
std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const smlm::LocalisationTable& superparticle,
                                      const RenderOptions& render);

}  // namespace polar
