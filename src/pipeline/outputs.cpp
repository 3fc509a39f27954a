#include "polar/pipeline/outputs.hpp"

#include <filesystem>

#include "polar/results/mrc.hpp"
#include "polar/results/picasso.hpp"
#include "polar/results/ply.hpp"
#include "polar/results/preview.hpp"
#include "polar/results/star.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/thunderstorm.hpp"
#include "polar/results/tiff.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace polar {

namespace {
using Notes = std::vector<std::string>;

void note_growth(const Volume& volume, const RenderOptions& options, Notes& notes) {
  if (volume.voxel_nm <= volume.wished_voxel_nm) return;
  notes.push_back("voxels are " + smlm::number_text(volume.voxel_nm) + " nm instead of " +
                  smlm::number_text(volume.wished_voxel_nm) + " nm: no axis gets more than " +
                  std::to_string(options.most_voxels_per_axis));
}

Volume drawn(const ExportInput& in, Notes& notes) {
  Volume volume = render(in.superparticle, in.render);
  note_growth(volume, in.render, notes);
  return volume;
}

// One volume a channel; one without a name where there are no channels.
std::vector<ChannelVolume> drawn_channels(const ExportInput& in, Notes& notes) {
  std::vector<ChannelVolume> channels = render_channels(in.superparticle, in.render);
  if (channels.empty())
    channels.push_back({"", drawn(in, notes)});
  else
    note_growth(channels.front().volume, in.render, notes);
  return channels;
}

void vtkhdf(const std::string& folder, const ExportInput& in, Notes& notes) {
  write_points_vtkhdf(folder + "aligned.hdf", in.superparticle);
  write_volume_vtkhdf(folder + "template.hdf", drawn(in, notes),
                      render_channels(in.superparticle, in.render));
}

void csv(const std::string& folder, const ExportInput& in, Notes&) {
  smlm::write_file_atomically(folder + "aligned.csv", format_table_csv(in.superparticle));
}

void png(const std::string& folder, const ExportInput& in, Notes& notes) {
  write_preview_png(folder + "preview.png", drawn_channels(in, notes));
}

void tiff(const std::string& folder, const ExportInput& in, Notes& notes) {
  std::vector<Volume> volumes;
  for (ChannelVolume& c : drawn_channels(in, notes)) volumes.push_back(std::move(c.volume));
  write_imagej_tiff(folder + "template.tif", volumes);
}

void ply(const std::string& folder, const ExportInput& in, Notes&) {
  write_ply(folder + "aligned.ply", in.superparticle);
}

void picasso(const std::string& folder, const ExportInput& in, Notes& notes) {
  const smlm::LocalisationTable& table = in.superparticle;
  write_picasso(folder + "aligned.hdf5", table, picasso_shift_nm(table));
  const std::vector<std::int32_t> groups = picasso_groups(table.particle_names);
  std::size_t renamed = 0;
  for (std::size_t i = 0; i < groups.size(); ++i)
    renamed += std::to_string(groups[i]) != table.particle_names[i];
  if (renamed > 0) {
    notes.push_back("Picasso's groups are whole numbers: " + std::to_string(renamed) + " of " +
                    std::to_string(groups.size()) + " particles got one, which aligned_particles.csv lists");
  }
}

void thunderstorm(const std::string& folder, const ExportInput& in, Notes&) {
  smlm::write_file_atomically(folder + "aligned_thunderstorm.csv", format_thunderstorm_csv(in.superparticle));
}

void mrc(const std::string& folder, const ExportInput& in, Notes& notes) {
  write_mrc(folder + "template.mrc", drawn(in, notes));
}

void star(const std::string& folder, const ExportInput& in, Notes&) {
  smlm::write_file_atomically(folder + "poses.star", format_star(in.poses));
}

void sites(const std::string& folder, const ExportInput& in, Notes&) {
  smlm::write_file_atomically(
      folder + "sites.csv", format_sites_csv(in.sites ? *in.sites : find_sites(in.superparticle, in.render)));
}
}  // namespace

const std::vector<OutputFormat>& output_formats() {
  static const std::vector<OutputFormat> formats = {
      {"vtkhdf", {"aligned.hdf", "template.hdf"}, vtkhdf},
      {"csv", {"aligned.csv"}, csv},
      {"png", {"preview.png"}, png},
      {"tiff", {"template.tif"}, tiff},
      {"ply", {"aligned.ply"}, ply},
      {"picasso", {"aligned.hdf5", "aligned.yaml", "aligned_particles.csv"}, picasso},
      {"thunderstorm", {"aligned_thunderstorm.csv"}, thunderstorm},
      {"mrc", {"template.mrc"}, mrc},
      {"star", {"poses.star"}, star, true},
      {"sites", {"sites.csv"}, sites}};
  return formats;
}

std::vector<std::string> export_formats() {
  std::vector<std::string> names;
  for (const OutputFormat& format : output_formats()) names.push_back(format.name);
  return names;
}

std::vector<std::string> table_formats() {
  std::vector<std::string> names;
  for (const OutputFormat& format : output_formats())
    if (!format.needs_poses) names.push_back(format.name);
  return names;
}

const std::vector<std::string>& half_map_files() {
  static const std::vector<std::string> names = {"half_1.mrc", "half_2.mrc"};
  return names;
}

std::string report_name(const std::string& directory) {
  std::error_code unseen;  // a folder that cannot be seen has no better name than the one given
  const std::filesystem::path whole = std::filesystem::absolute(directory, unseen).lexically_normal();
  const std::filesystem::path last = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
  return last.empty() ? directory : last.string();
}

std::vector<std::string> result_files() {
  std::vector<std::string> names = {"poses.csv", "results.h5", "summary.json", kReportFile};
  names.insert(names.end(), half_map_files().begin(), half_map_files().end());
  for (const OutputFormat& format : output_formats())
    names.insert(names.end(), format.files.begin(), format.files.end());
  return names;
}

std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const ExportInput& input, std::vector<std::string>& notes) {
  for (const OutputFormat& known : output_formats()) {
    if (known.name != format) continue;
    known.write(directory + "/", input, notes);
    return known.files;
  }
  throw smlm::Error(smlm::Fault::usage, "format", "'" + format + "' is not known",
                    "use one that polar export --help lists");
}

}  // namespace polar
