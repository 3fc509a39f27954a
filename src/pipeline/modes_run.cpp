#include "polar/pipeline/modes_run.hpp"

#include "drawn_points.hpp"
#include "json_text.hpp"
#include "modes_tables.hpp"
#include "output_directory.hpp"
#include "polar/pipeline/version.hpp"
#include "polar/results/preview.hpp"
#include "polar/results/sites.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/table_reader.hpp"

namespace polar {

namespace {
using fitting::FitData;
using fitting::ModesReport;

constexpr std::size_t kFewestParticles = 10;
constexpr int kFewestSites = 3;

struct Places {
  Eigen::Matrix3Xd site_nm;
  std::string origin;  // in words
};

Places places_of(const ModesRunOptions& o, const PlacedParticles& particles, const FitData& together) {
  if (!o.sites.empty()) {
    smlm::ReadOptions read;
    read.positions_only = true;
    const smlm::LocalisationTable table = smlm::read_table(o.sites, read);
    Eigen::Matrix3Xd site_nm(3, static_cast<Eigen::Index>(table.size()));
    for (std::size_t k = 0; k < table.size(); ++k)
      site_nm.col(static_cast<Eigen::Index>(k)) << table.position_nm[k][0], table.position_nm[k][1],
          table.position_nm[k][2];
    return {site_nm, "of " + o.sites};
  }
  const DiscreteSites found = find_sites(particles.table, particles.render);
  if (found.site.empty())
    return {fitting::landmarks(together, o.landmarks, o.modes.seed),
            "landmarks: sites cannot be told apart, " + found.reason};
  Eigen::Matrix3Xd site_nm(3, static_cast<Eigen::Index>(found.site.size()));
  for (std::size_t k = 0; k < found.site.size(); ++k)
    site_nm.col(static_cast<Eigen::Index>(k)) = found.site[k].centre_nm;
  return {site_nm, "found in the superparticle"};
}

// The average at the lowest and at the highest score that are written, in two colours.
void write_mode_picture(const std::string& path, const ModesReport& report, const fitting::Mode& mode,
                        const smlm::LocalisationTable& table) {
  const Eigen::VectorXd weight = report.occupancy / report.occupancy.sum();
  const auto drawn = [&](double score) {
    return pipeline::drawn_points(pipeline::sites_at(report, mode, score), weight, report.width_nm, table);
  };
  const Volume box = render(table);
  write_preview_png(path, {{"low", render_into(box, drawn(pipeline::shown_scores().front()))},
                           {"high", render_into(box, drawn(pipeline::shown_scores().back()))}});
}
}  // namespace

std::vector<std::string> run_modes(const ModesRunOptions& o, Progress& progress) {
  smlm::throw_if_any(violations(o.modes), smlm::Fault::usage, "polar modes");
  const PlacedParticles particles = read_placed_particles(o.input);
  if (!particles.placed)
    throw smlm::Error(smlm::Fault::usage, o.input.inputs.front(), "is a table without poses",
                      "give a result, or the particles' poses with --poses");
  for (const std::string& warning : particles.warnings) progress.note("warning: " + warning);
  std::vector<FitData> data;
  std::vector<std::string> name;
  const auto all = fitting::particles_of(particles.table, o.modes.burst_distance, o.modes.seed);
  for (std::size_t p = 0; p < all.size(); ++p)
    if (all[p].size() > 0) data.push_back(all[p]), name.push_back(particles.table.particle_names[p]);
  if (data.size() < kFewestParticles)
    throw smlm::Error(smlm::Fault::input, o.input.inputs.front(),
                      "has " + std::to_string(data.size()) + " particles with a pose",
                      "modes need " + std::to_string(kFewestParticles) + " or more");
  const pipeline::OutputDirectory directory(
      o.directory.empty() ? folder_beside(o.input, "modes") : o.directory, {o.overwrite, false});
  const Places places = places_of(o, particles, fitting::superparticle_of(data));
  if (places.site_nm.cols() < kFewestSites)
    throw smlm::Error(smlm::Fault::input, o.sites.empty() ? o.input.inputs.front() : o.sites,
                      "holds " + std::to_string(places.site_nm.cols()) + " sites", "modes need 3 or more");
  progress.step("modes", 0, 1);
  const ModesReport report = find_modes(data, places.site_nm, o.modes);

  for (std::size_t m = 0; m < report.position.size(); ++m)
    if (report.position[m].above_noise)
      write_mode_picture(directory.file("mode_" + std::to_string(m + 1) + ".png"), report, report.position[m],
                         particles.table);
  nlohmann::json json = pipeline::modes_json(report);
  json["program"] = program_version(), json["command"] = o.command, json["inputs"] = o.input.inputs;
  json["sites_are"] = places.origin;
  json["particles"] = data.size();
  json["options"] = {{"seed", o.modes.seed},
                     {"modes", o.modes.modes},
                     {"draws", o.modes.draws},
                     {"pose_std_deg", o.modes.pose_std_deg},
                     {"pose_std_nm", o.modes.pose_std_nm},
                     {"burst_distance", o.modes.burst_distance},
                     {"landmarks", o.landmarks}};
  smlm::write_file_atomically(directory.file("modes.csv"), pipeline::modes_csv(report));
  smlm::write_file_atomically(directory.file("scores.csv"), pipeline::scores_csv(report, name));
  smlm::write_file_atomically(directory.file("mode_sites.csv"), pipeline::mode_sites_csv(report));
  smlm::write_file_atomically(directory.file("modes.json"), pipeline::json_text(json));
  std::vector<std::string> lines = {
      "particles    " + std::to_string(data.size()),
      "sites        " + std::to_string(report.site_nm.cols()) + " (" + places.origin + ")"};
  for (const std::string& line : pipeline::modes_lines(report)) lines.push_back(line);
  lines.push_back("written to   " + directory.file("modes.csv"));
  return lines;
}

}  // namespace polar
