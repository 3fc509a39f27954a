// `polar fit`: a geometric model measured on the superparticle and on every particle.
#pragma once

#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/fitting/fit.hpp"
#include "polar/pipeline/placed_particles.hpp"

namespace polar {

struct FitRunOptions {
  PlacedInput input;
  std::string model;              // name of a shipped model, or a file
  std::string sites;              // table of x, y, z for parts `sites`; empty: none
  std::vector<std::string> hold;  // name or name=value
  std::string directory;          // to write into; empty: fit_<model> beside the first input
  bool overwrite = false;
  bool evidence = true;  // hold the model against the free template
  fitting::FitOptions fit;
  std::string command{};  // as typed; kept in fit.json
};

/// Names of the shipped models.
std::vector<std::string> fit_models();

/// Files that a fit writes.
const std::vector<std::string>& fit_files();

/// Writes fit.csv (a line for the superparticle where poses are known, and one a particle), fit.json,
/// model.csv (the fitted geometry as points, with it fit.png where poses are known). Returns the lines to
/// show the user. Throws smlm::Error; numerical where nothing could be fitted.
std::vector<std::string> run_fit(const FitRunOptions& options, Progress& progress);

}  // namespace polar
