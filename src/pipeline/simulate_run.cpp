#include "polar/pipeline/simulate_run.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "json_text.hpp"
#include "polar/core/constants.hpp"
#include "polar/results/picasso.hpp"
#include "polar/results/pose_table.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/simulation/cramer_rao.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace polar {

namespace {
constexpr const char* kTruthFile = "truth.json";

std::vector<PoseRow> true_poses(const Simulation& s, bool with_bound) {
  std::vector<PoseRow> rows(s.particle.size());
  for (const std::int64_t p : s.table.particle) ++rows[static_cast<std::size_t>(p)].n_localisations;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    PoseRow& r = rows[i];
    const SimulatedParticle& p = s.particle[i];
    r.particle = s.table.particle_names[i];
    r.n_used = r.n_localisations;
    r.accepted = true;
    r.template_from_view = p.structure_from_view;
    if (!with_bound) continue;
    r.rotation_std_deg = kDegreesPerRadian * std::sqrt(p.covariance.topLeftCorner<3, 3>().trace());
    r.translation_std_nm = std::sqrt(p.covariance.bottomRightCorner<3, 3>().trace());
  }
  return rows;
}

std::string sites_text(const Structure& structure) {
  std::string text = "x [nm],y [nm],z [nm]\n";
  char line[128];
  for (Eigen::Index k = 0; k < structure.site_nm.cols(); ++k) {
    std::snprintf(line, sizeof line, "%.6f,%.6f,%.6f\n", structure.site_nm(0, k), structure.site_nm(1, k),
                  structure.site_nm(2, k));
    text += line;
  }
  return text;
}

// Each copy's own shape, where copies differ.
std::string shapes_text(const Simulation& s) {
  std::string text = "particle,radius_change_nm,height_change_nm\n";
  for (std::size_t i = 0; i < s.particle.size(); ++i)
    text += s.table.particle_names[i] + "," + smlm::number_text(s.particle[i].radius_change_nm) + "," +
            smlm::number_text(s.particle[i].height_change_nm) + "\n";
  return text;
}

// In the plane the two-fold axes of a flat structure are out of reach.
std::string observable_symmetry(const Structure& structure, bool planar) {
  return planar && structure.symmetry[0] == 'D' ? "C" + structure.symmetry.substr(1) : structure.symmetry;
}

// The configuration as it can be handed on: without where it was run.
std::string portable_text(SimulateConfig config) {
  config.directory = std::filesystem::path(config.directory).filename().string();
  config.file.path = std::filesystem::path(config.file.path).filename().string();
  return simulate_config_text(config);
}

// Moves the table, and the true poses with it.
void shift(Simulation& s, const std::array<double, 2>& by_nm) {
  for (auto& x : s.table.position_nm)
    for (std::size_t axis = 0; axis < 2; ++axis) x[axis] += by_nm[axis];
  for (SimulatedParticle& p : s.particle)
    p.structure_from_view.translation -=
        p.structure_from_view.rotation * Eigen::Vector3d(by_nm[0], by_nm[1], 0);
}

void prepare_directory(const SimulateConfig& config, bool overwrite) {
  std::error_code ec;
  std::filesystem::create_directories(config.directory, ec);
  if (ec || !std::filesystem::is_directory(config.directory, ec))
    throw smlm::Error(smlm::Fault::io, config.directory, "cannot be created as a folder",
                      "choose another output.directory");
  if (!overwrite && std::filesystem::exists(config.directory + "/poses.csv", ec))
    throw smlm::Error(smlm::Fault::io, config.directory, "holds a simulation already",
                      "choose another output.directory or give --overwrite");
}
}  // namespace

std::vector<std::string> run_simulation(const SimulateConfig& config, bool overwrite) {
  prepare_directory(config, overwrite);
  const Structure structure =
      config.structure.kind == "file" ? read_structure(config.file) : make_structure(config.structure);
  Simulation s = simulate(structure, config.simulation);
  const std::string folder = config.directory + "/";
  TruthSummary truth{structure.name, observable_symmetry(structure, config.simulation.planar),
                     std::numeric_limits<double>::quiet_NaN()};
  if (config.simulation.cramer_rao) {
    std::vector<Eigen::Matrix<double, 6, 6>> bound;
    for (const SimulatedParticle& p : s.particle) bound.push_back(p.covariance);
    truth.cramer_rao_pair_median_deg = pair_median_deg(bound, config.simulation.seed);
  }
  const nlohmann::json summary = {{"structure", truth.structure},
                                  {"symmetry", truth.symmetry},
                                  {"cramer_rao_pair_median_deg", truth.cramer_rao_pair_median_deg}};
  if (config.format == "picasso") {
    shift(s, picasso_shift_nm(s.table));
    write_picasso(folder + "localisations.hdf5", s.table);
  } else {
    smlm::write_file_atomically(folder + "localisations.csv", format_table_csv(s.table));
  }
  smlm::write_file_atomically(folder + "poses.csv",
                              format_pose_table(true_poses(s, config.simulation.cramer_rao)));
  smlm::write_file_atomically(folder + "sites.csv", sites_text(structure));
  if (config.simulation.radius_std_nm > 0 || config.simulation.height_std_nm > 0)
    smlm::write_file_atomically(folder + "shapes.csv", shapes_text(s));
  smlm::write_file_atomically(folder + "simulation.yaml", portable_text(config));
  smlm::write_file_atomically(folder + kTruthFile, pipeline::json_text(summary));

  std::vector<std::string> lines = {std::to_string(s.particle.size()) + " particles of " + structure.name +
                                        " (" + truth.symmetry + "), " + std::to_string(s.table.size()) +
                                        " localisations",
                                    "written to " + config.directory};
  for (const std::string& warning : structure.warnings) lines.push_back("warning: " + warning);
  if (std::isfinite(truth.cramer_rao_pair_median_deg))
    lines.push_back("Cramer-Rao bound, median over pairs: " +
                    std::to_string(truth.cramer_rao_pair_median_deg) + " degrees");
  return lines;
}

bool read_truth_summary(const std::string& poses_csv, TruthSummary& summary) {
  const std::string path = (std::filesystem::path(poses_csv).parent_path() / kTruthFile).string();
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return false;
  std::ifstream in(path);
  if (!in) return false;
  const nlohmann::json parsed = nlohmann::json::parse(in, nullptr, false);
  const auto text = [&](const char* key) {
    if (!parsed.is_object() || !parsed.contains(key) || !parsed[key].is_string())
      throw smlm::Error(smlm::Fault::input, path, std::string("has no text '") + key + "'", "simulate again");
    return parsed[key].get<std::string>();
  };
  summary.structure = text("structure");
  summary.symmetry = text("symmetry");
  const auto bound = parsed.find("cramer_rao_pair_median_deg");  // null stands for NaN
  summary.cramer_rao_pair_median_deg = bound != parsed.end() && bound->is_number()
                                           ? bound->get<double>()
                                           : std::numeric_limits<double>::quiet_NaN();
  return true;
}

}  // namespace polar
