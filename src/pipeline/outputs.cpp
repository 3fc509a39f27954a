#include "polar/pipeline/outputs.hpp"

#include "polar/results/picasso.hpp"
#include "polar/results/preview.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

std::vector<std::string> export_formats() { return {"vtkhdf", "csv", "png", "picasso"}; }

std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const smlm::LocalisationTable& superparticle,
                                      const RenderOptions& options) {
  const std::string folder = directory + "/";
  if (format == "vtkhdf") {
    write_points_vtkhdf(folder + "aligned.hdf", superparticle);
    write_volume_vtkhdf(folder + "template.hdf", render(superparticle, options));
    return {"aligned.hdf", "template.hdf"};
  }
  if (format == "csv") {
    smlm::write_file_atomically(folder + "aligned.csv", format_table_csv(superparticle));
    return {"aligned.csv"};
  }
  if (format == "png") {
    write_preview_png(folder + "preview.png", render(superparticle, options));
    return {"preview.png"};
  }
  if (format == "picasso") {
    smlm::LocalisationTable shifted = superparticle;
    const std::array<double, 2> shift = picasso_shift_nm(shifted);
    for (auto& x : shifted.position_nm)
      for (std::size_t axis = 0; axis < 2; ++axis) x[axis] += shift[axis];
    write_picasso(folder + "aligned.hdf5", shifted);
    return {"aligned.hdf5", "aligned.yaml"};
  }
  throw smlm::Error(smlm::Fault::usage, "format", "'" + format + "' is not known",
                    "use vtkhdf, csv, png or picasso");
}

}  // namespace polar
