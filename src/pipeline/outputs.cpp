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

namespace polar {

namespace {
using smlm::LocalisationTable;

void vtkhdf(const std::string& folder, const LocalisationTable& table, const RenderOptions& options) {
  write_points_vtkhdf(folder + "aligned.hdf", table);
  write_volume_vtkhdf(folder + "template.hdf", render(table, options));
}

void csv(const std::string& folder, const LocalisationTable& table, const RenderOptions&) {
  smlm::write_file_atomically(folder + "aligned.csv", format_table_csv(table));
}

void png(const std::string& folder, const LocalisationTable& table, const RenderOptions& options) {
  write_preview_png(folder + "preview.png", render(table, options));
}

void tiff(const std::string& folder, const LocalisationTable& table, const RenderOptions& options) {
  write_imagej_tiff(folder + "template.tif", render(table, options));
}

void ply(const std::string& folder, const LocalisationTable& table, const RenderOptions&) {
  write_ply(folder + "aligned.ply", table);
}

void picasso(const std::string& folder, const LocalisationTable& table, const RenderOptions&) {
  write_picasso(folder + "aligned.hdf5", table, picasso_shift_nm(table));
}

void thunderstorm(const std::string& folder, const LocalisationTable& table, const RenderOptions&) {
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
      {"picasso", {"aligned.hdf5", "aligned.yaml"}, picasso},
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
                                      const LocalisationTable& superparticle, const RenderOptions& options) {
  for (const OutputFormat& known : output_formats()) {
    if (known.name != format) continue;
    known.write(directory + "/", superparticle, options);
    return known.files;
  }
  throw smlm::Error(smlm::Fault::usage, "format", "'" + format + "' is not known",
                    "use one that polar export --help lists");
}

}  // namespace polar
