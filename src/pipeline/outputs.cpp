#include "polar/pipeline/outputs.hpp"

#include <filesystem>

#include "polar/results/picasso.hpp"
#include "polar/results/ply.hpp"
#include "polar/results/preview.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/thunderstorm.hpp"
#include "polar/results/tiff.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace polar {

namespace {
using smlm::LocalisationTable;
using Notes = std::vector<std::string>;

Volume drawn(const LocalisationTable& table, const RenderOptions& options, Notes& notes) {
  Volume volume = render(table, options);
  if (volume.voxel_nm > volume.wished_voxel_nm) {
    notes.push_back("voxels are " + smlm::number_text(volume.voxel_nm) + " nm instead of " +
                    smlm::number_text(volume.wished_voxel_nm) + " nm: no axis gets more than " +
                    std::to_string(options.most_voxels_per_axis));
  }
  return volume;
}

void vtkhdf(const std::string& folder, const LocalisationTable& table, const RenderOptions& options,
            Notes& notes) {
  write_points_vtkhdf(folder + "aligned.hdf", table);
  write_volume_vtkhdf(folder + "template.hdf", drawn(table, options, notes));
}

void csv(const std::string& folder, const LocalisationTable& table, const RenderOptions&, Notes&) {
  smlm::write_file_atomically(folder + "aligned.csv", format_table_csv(table));
}

void png(const std::string& folder, const LocalisationTable& table, const RenderOptions& options,
         Notes& notes) {
  write_preview_png(folder + "preview.png", drawn(table, options, notes));
}

void tiff(const std::string& folder, const LocalisationTable& table, const RenderOptions& options,
          Notes& notes) {
  write_imagej_tiff(folder + "template.tif", drawn(table, options, notes));
}

void ply(const std::string& folder, const LocalisationTable& table, const RenderOptions&, Notes&) {
  write_ply(folder + "aligned.ply", table);
}

void picasso(const std::string& folder, const LocalisationTable& table, const RenderOptions&, Notes& notes) {
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

void thunderstorm(const std::string& folder, const LocalisationTable& table, const RenderOptions&, Notes&) {
  smlm::write_file_atomically(folder + "aligned_thunderstorm.csv", format_thunderstorm_csv(table));
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
      {"thunderstorm", {"aligned_thunderstorm.csv"}, thunderstorm}};
  return formats;
}

std::vector<std::string> export_formats() {
  std::vector<std::string> names;
  for (const OutputFormat& format : output_formats()) names.push_back(format.name);
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
  for (const OutputFormat& format : output_formats())
    names.insert(names.end(), format.files.begin(), format.files.end());
  return names;
}

std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const LocalisationTable& superparticle, const RenderOptions& options,
                                      std::vector<std::string>& notes) {
  for (const OutputFormat& known : output_formats()) {
    if (known.name != format) continue;
    known.write(directory + "/", superparticle, options, notes);
    return known.files;
  }
  throw smlm::Error(smlm::Fault::usage, "format", "'" + format + "' is not known",
                    "use one that polar export --help lists");
}

}  // namespace polar
