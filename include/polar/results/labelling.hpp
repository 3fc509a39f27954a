// How many of the places that could carry a label do.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace polar {

/// Which places particles show. A doubtful place counts as much as it is probable.
struct PlaceCounts {
  std::vector<double> occupancy;  // of every place: share of the particles with a label there
  std::vector<double> particles;  // [n]: particles with n labelled places, from 0 to all
  std::vector<double> labels;     // [k]: labelled places with k localisations
  double doubt = 0;               // variance of a particle's number of labelled places that is left, mean
  double background_share = 0;    // of the localisations

  bool any() const;  // whether a particle shows a place
};

struct Labelling {
  double efficiency = 0, low = 0,
         high = 0;            // probability that a place carries a label, and its 95 % interval
  int sites = 0;              // of the template, or its symmetric units
  std::string of = "sites";   // what is counted: sites | symmetric units
  int labels_per_site = 1;    // places that are one site
  std::size_t particles = 0;  // that were counted
  int fewest = 1;             // sites that a particle needs to be among them
  double dispersion = 1;      // variance over that of independent labels; above 1 widens the interval
  double information = 1;     // share of what certain counts would tell; below 1 widens the interval
};

/// From the numbers of occupied sites of particles: a binomial distribution of which the smallest counts may
/// be missing, because particles that show too little are not seen or not accepted. Counts below the smallest
/// one that is as frequent as the larger ones make one expect are left out (`fewest`), unless chance explains
/// that they are so few; particles without any site always. A site of several labels is occupied where any
/// is. Interval by the likelihood ratio, at the information that the doubt about places leaves
/// (T. Louis, J. R. Stat. Soc. B 44, 226-233, 1982). At least one particle shows a site.
Labelling labelling_efficiency(const PlaceCounts& counts, int labels_per_site);

}  // namespace polar
