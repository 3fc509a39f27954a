#include "polar/pipeline/placed_particles.hpp"

#include <algorithm>
#include <filesystem>

#include "named_poses.hpp"
#include "polar/pipeline/run_config.hpp"
#include "polar/results/registering_rows.hpp"
#include "polar/results/results.hpp"
#include "smlm/error.hpp"
#include "smlm/isolation.hpp"
#include "smlm/particle_set.hpp"
#include "smlm/table_reader.hpp"

namespace polar {

namespace {
PlacedParticles of_record(const std::string& path) {
  const ResultRecord record = smlm::read_isolated(path, [&] { return read_result_file(path); });
  PlacedParticles out;
  out.placed = true;
  out.table = record.superparticle;
  if (!record.render.channel_column.empty())
    out.table =
        registering_rows(out.table, {record.render.channel_column, false, record.registering_channels});
  out.table = calibrated(out.table, record.render);
  out.sites = record.sites;
  return out;
}

// A table that names no particle is one.
smlm::LocalisationTable read_tables_of(const PlacedInput& input, std::vector<std::string>& warnings) {
  smlm::ReadOptions read = read_options(input.overrides);
  smlm::LocalisationTable table = smlm::read_tables(input.inputs, read);
  const bool said = std::any_of(input.overrides.begin(), input.overrides.end(), [](const std::string& o) {
    return o.compare(0, 15, "input.particles") == 0 || o.compare(0, 13, "input.columns") == 0;
  });
  if (table.particle_names.empty() && table.unassigned.empty() && !said) {
    read.particles = "one_per_file";
    table = smlm::read_tables(input.inputs, read);
    warnings.push_back("no column names the particles: every file is taken as one (input.particles)");
  }
  return table;
}

PlacedParticles of_tables(const PlacedInput& input) {
  PlacedParticles out;
  const smlm::ParticleSet set = smlm::group_particles(read_tables_of(input, out.warnings));
  out.warnings.insert(out.warnings.end(), set.table.warnings.begin(), set.table.warnings.end());
  if (set.particles.empty())
    throw smlm::Error(smlm::Fault::input, input.inputs.front(), "holds no particle",
                      "name their column under input.columns.particle (--set)");
  std::vector<std::optional<Pose>> pose(set.particles.size(), Pose{});
  out.placed = !input.poses.empty();
  if (out.placed) {
    const pipeline::NamedPoses known = pipeline::read_named_poses(input.poses);
    std::size_t found = 0;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      const auto at = known.find(set.particles[i].name);
      pose[i] = at == known.end() ? std::nullopt : at->second;
      found += pose[i] ? 1 : 0;
    }
    if (found == 0)
      throw smlm::Error(
          smlm::Fault::input, input.poses,
          "has no pose of any particle of the tables ('" + set.particles.front().name + "', ...)",
          "the tables must name particles as the poses do");
  }
  out.table = aligned(set, pose);
  out.table.planar = set.table.planar;
  return out;
}
}  // namespace

std::string folder_beside(const PlacedInput& input, const std::string& name) {
  std::error_code unseen;
  const std::filesystem::path first = input.inputs.front();
  return ((std::filesystem::is_directory(first, unseen) ? first : first.parent_path()) / name).string();
}

PlacedParticles read_placed_particles(const PlacedInput& input) {
  std::error_code unseen;
  const std::string& first = input.inputs.front();
  const bool folder = std::filesystem::is_directory(first, unseen);
  const std::string record = folder ? first + "/results.h5" : first;
  if (!folder && !is_result_file(record)) return of_tables(input);
  const char* unfit = input.inputs.size() > 1    ? "a result is given alone"
                      : !input.poses.empty()     ? "--poses is for tables: a result has its own"
                      : !input.overrides.empty() ? "--set is for tables: a result has been read"
                                                 : nullptr;
  if (unfit) throw smlm::Error(smlm::Fault::usage, first, unfit);
  return of_record(record);
}

}  // namespace polar
