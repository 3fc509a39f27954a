#include "polar/latent/options.hpp"

namespace polar {

std::vector<std::string> violations(const LatentOptions& o) {
  std::vector<std::string> faults;
  const auto require = [&](bool good, const char* sentence) {
    if (!good) faults.emplace_back(sentence);
  };
  require(o.search == "fast" || o.search == "exhaustive", "search must be fast or exhaustive");
  require(o.optimizer == "levenberg_marquardt" || o.optimizer == "adamw",
          "optimizer must be levenberg_marquardt or adamw");
  require(o.template_kind == "fused" || o.template_kind == "decoded",
          "latent.template must be fused or decoded");
  require(o.noise == "per_localisation" || o.noise == "common" || o.noise == "none",
          "latent.noise must be per_localisation, common or none");
  require(o.localisations >= 16, "latent.localisations must be at least 16");
  require(o.visibility == 0 || (o.visibility >= 0.1 && o.visibility <= 1),
          "latent.visibility must lie between 0.1 and 1, or be 0 (estimated)");
  require(o.outlier_fraction == -1 || (o.outlier_fraction >= 0 && o.outlier_fraction <= 0.9),
          "latent.outlier_fraction must lie between 0 and 0.9, or be -1 (estimated)");
  require(o.regularisation >= 0, "latent.regularisation must be 0 or more");
  require(o.regularisation_radius > 0, "latent.regularisation_radius must be positive");
  require(o.medoids >= 0 && o.medoids <= 16, "latent.medoids must lie between 0 and 16");
  require(o.basins >= 1, "latent.basins must be at least 1");
  require(o.rotations == 0 || o.rotations >= 100, "latent.rotations must be at least 100, or 0");
  require(o.most_loops >= 1, "latent.most_loops must be at least 1");
  require(o.escape_deg > 0 && o.escape_deg < 180, "latent.escape_deg must lie between 0 and 180");
  return faults;
}

}  // namespace polar
