#include "polar/pipeline/outputs.hpp"

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

namespace polar {

namespace {
void vtkhdf(const std::string& folder, const ExportInput& in) {
  write_points_vtkhdf(folder + "aligned.hdf", in.superparticle);
  write_volume_vtkhdf(folder + "template.hdf", render(in.superparticle, in.render),
                      render_channels(in.superparticle, in.render));
}

void csv(const std::string& folder, const ExportInput& in) {
  smlm::write_file_atomically(folder + "aligned.csv", format_table_csv(in.superparticle));
}

void png(const std::string& folder, const ExportInput& in) {
  std::vector<ChannelVolume> channels = render_channels(in.superparticle, in.render);
  if (channels.empty()) channels.push_back({"", render(in.superparticle, in.render)});
  write_preview_png(folder + "preview.png", channels);
}

void tiff(const std::string& folder, const ExportInput& in) {
  std::vector<Volume> volumes;
  for (ChannelVolume& c : render_channels(in.superparticle, in.render))
    volumes.push_back(std::move(c.volume));
  if (volumes.empty()) volumes.push_back(render(in.superparticle, in.render));
  write_imagej_tiff(folder + "template.tif", volumes);
}

void ply(const std::string& folder, const ExportInput& in) {
  write_ply(folder + "aligned.ply", in.superparticle);
}

void picasso(const std::string& folder, const ExportInput& in) {
  write_picasso(folder + "aligned.hdf5", in.superparticle, picasso_shift_nm(in.superparticle));
}

void thunderstorm(const std::string& folder, const ExportInput& in) {
  smlm::write_file_atomically(folder + "aligned_thunderstorm.csv", format_thunderstorm_csv(in.superparticle));
}

void mrc(const std::string& folder, const ExportInput& in) {
  write_mrc(folder + "template.mrc", render(in.superparticle, in.render));
}

void star(const std::string& folder, const ExportInput& in) {
  smlm::write_file_atomically(folder + "poses.star", format_star(in.poses));
}

void sites(const std::string& folder, const ExportInput& in) {
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
      {"picasso", {"aligned.hdf5", "aligned.yaml"}, picasso},
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

std::vector<std::string> result_files() {
  std::vector<std::string> names = {"poses.csv", "results.h5", "summary.json"};
  names.insert(names.end(), half_map_files().begin(), half_map_files().end());
  for (const OutputFormat& format : output_formats())
    names.insert(names.end(), format.files.begin(), format.files.end());
  return names;
}

std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const ExportInput& input) {
  for (const OutputFormat& known : output_formats()) {
    if (known.name != format) continue;
    known.write(directory + "/", input);
    return known.files;
  }
  throw smlm::Error(smlm::Fault::usage, "format", "'" + format + "' is not known",
                    "use one that polar export --help lists");
}

}  // namespace polar
