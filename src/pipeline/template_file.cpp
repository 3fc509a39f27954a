#include "template_file.hpp"

#include <filesystem>

#include "polar/results/result_file.hpp"
#include "polar/simulation/structure_file.hpp"
#include "smlm/error.hpp"
#include "smlm/isolation.hpp"

namespace polar::pipeline {

KnownTemplate read_template(const std::string& path) {
  KnownTemplate known;
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".h5" || extension == ".hdf5") {
    const TemplateSites sites = smlm::read_isolated(path, [&] { return read_result_file(path); }).sites;
    known.site_nm = sites.centre_nm;
    known.weight.assign(sites.weight.data(), sites.weight.data() + sites.weight.size());
  } else {
    StructureFile file;
    file.path = path;
    known.site_nm = read_structure(file).site_nm;
    known.weight.assign(static_cast<std::size_t>(known.site_nm.cols()), 1.0);
  }
  double total = 0;
  for (const double w : known.weight) total += w;
  if (known.site_nm.cols() < 2 || !known.site_nm.allFinite() || !(total > 0))
    throw smlm::Error(
        smlm::Fault::input, path, "holds no template",
        "registration.template is a table of at least two sites (x, y, z in nm) or a results.h5");
  return known;
}

}  // namespace polar::pipeline
