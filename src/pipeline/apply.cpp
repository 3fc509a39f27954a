#include "polar/pipeline/apply.hpp"

#include <filesystem>
#include <optional>

#include "named_poses.hpp"
#include "output_directory.hpp"
#include "polar/pipeline/outputs.hpp"
#include "polar/results/results.hpp"
#include "smlm/error.hpp"
#include "smlm/table_reader.hpp"

namespace polar {

namespace {
constexpr double kInPlane = 1e-9;  // of a rotation's z axis: what text with 17 digits leaves of 0

std::string poses_file(const std::string& result) {
  std::error_code unseen;  // whoever opens it says why
  return std::filesystem::is_directory(result, unseen) ? result + "/poses.csv" : result;
}

bool turns_out_of_plane(const Pose& pose) {
  return std::abs(pose.rotation(2, 2) - 1) > kInPlane || std::abs(pose.translation.z()) > kInPlane;
}
}  // namespace

std::vector<std::string> apply_poses(const ApplyOptions& options) {
  const pipeline::OutputDirectory directory(options.directory, {options.overwrite, false});
  const std::string path = poses_file(options.result);
  const pipeline::NamedPoses poses = pipeline::read_named_poses(path);
  const smlm::ParticleSet set = smlm::group_particles(smlm::read_tables(options.tables, options.read));
  std::vector<std::optional<Pose>> pose;
  std::size_t moved = 0, unknown = 0;
  bool planar = set.table.planar;
  for (const smlm::Particle& particle : set.particles) {
    const auto found = poses.find(particle.name);
    unknown += found == poses.end() ? 1 : 0;
    pose.push_back(found != poses.end() ? found->second : std::nullopt);
    if (!pose.back()) continue;
    ++moved;
    planar = planar && !turns_out_of_plane(*pose.back());
  }
  if (moved == 0)
    throw smlm::Error(smlm::Fault::input, options.tables.front(),
                      "none of its particles ('" + set.particles.front().name + "', ...) has a pose in " +
                          path + (poses.empty() ? "" : " ('" + poses.begin()->first + "', ...)"),
                      "the tables must name particles as those of the run do");
  smlm::LocalisationTable table = aligned(set, pose);
  table.planar = planar;
  RenderOptions render;
  render.voxel_nm = options.voxel_nm;
  render.channel_column = smlm::channel_column(options.read.channel);
  std::vector<std::string> lines = {
      "particles    " + std::to_string(moved) + " moved, " +
          std::to_string(set.particles.size() - moved - unknown) + " were not accepted, " +
          std::to_string(unknown) + " are not in the result",
      "localisations " + std::to_string(table.size()) + " of " + std::to_string(set.table.size())};
  for (const std::string& warning : set.table.warnings) lines.push_back("warning      " + warning);
  std::vector<std::string> written, notes;
  for (const std::string& format : options.formats)
    for (const std::string& name : write_format(format, options.directory, {table, render}, notes))
      written.push_back(name);
  for (const std::string& note : notes) lines.push_back("warning      " + note);
  directory.remove_other_results(written);
  for (const std::string& name : written) lines.push_back(directory.file(name));
  return lines;
}

}  // namespace polar
