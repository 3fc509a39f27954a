#include "labelling_text.hpp"

#include <cstdio>

namespace polar::pipeline {

std::vector<std::string> labelling_lines(const DiscreteSites& sites, const Labelling* l) {
  if (!l) return {};
  char text[200];
  std::snprintf(text, sizeof text, "labelling    %.1f %% (%.1f to %.1f) of %d %s, from %zu particles",
                100 * l->efficiency, 100 * l->low, 100 * l->high, l->sites, l->of.c_str(), l->particles);
  std::vector<std::string> lines = {text};
  for (const std::size_t k : hot_spots(sites)) {
    const Eigen::Vector3d& c = sites.site[k].centre_nm;
    std::snprintf(
        text, sizeof text,
        "warning      the site at (%.1f %.1f %.1f) nm is on %.0f %% of the particles, far more than the "
        "others: a hot spot may be an artefact",
        c.x(), c.y(), c.z(), 100 * sites.site[k].occupancy);
    lines.emplace_back(text);
  }
  return lines;
}

void add_labelling(nlohmann::json& summary, const DiscreteSites& sites, const Labelling* l) {
  nlohmann::json& s = summary["sites"];
  s = {{"number", sites.site.size()}, {"reason", sites.reason}, {"background_share", sites.background_share}};
  s["hot_spots"] = hot_spots(sites);
  if (!l) return;
  summary["labelling"] = {{"efficiency", l->efficiency},
                          {"low", l->low},
                          {"high", l->high},
                          {"of", l->of},
                          {"sites", l->sites},
                          {"particles", l->particles},
                          {"labels_per_site", l->labels_per_site},
                          {"fewest_sites", l->fewest},
                          {"dispersion", l->dispersion},
                          {"information", l->information}};
}

}  // namespace polar::pipeline
