// The places of a discrete template: where labels sit, and how many particles carry one there.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/results/labelling.hpp"
#include "polar/results/render.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

struct Site {
  Eigen::Vector3d centre_nm = Eigen::Vector3d::Zero();
  double centre_std_nm = 0;  // of each coordinate, from the localisations' scatter about it
  double width_nm = 0;   // standard deviation along each axis beyond the localisations' stated uncertainties
  double share = 0;      // of the superparticle's localisations
  double occupancy = 0;  // share of the accepted particles with a label there
};

struct DiscreteSites {
  std::vector<Site> site;          // brightest first; none where the template is not discrete
  double background_share = 0;     // of localisations at no site
  PlaceCounts counts;              // of the accepted particles
  std::vector<std::size_t> orbit;  // of every site: the first one that the template's group carries it onto
  std::string reason = "never looked";  // why there are none; empty: there are
};

/// Maxima of the density, softened by the median uncertainty, are refined as a mixture of isotropic Gaussians
/// over the localisations' own covariances with an even background (expectation maximisation). Sites count as
/// discrete where each is farther than three standard deviations of a localisation from the next one and all
/// together hold most localisations. Every site is an orbit of its own.
DiscreteSites find_sites(const smlm::LocalisationTable& superparticle, const RenderOptions& render);

/// sites.csv: x_nm, y_nm, z_nm, centre_std_nm, width_nm, share, occupancy; a line a site, none where the
/// template is not discrete.
std::string format_sites_csv(const DiscreteSites& sites);

/// Puts the sites into one orbit that the group of rotations carries onto one another, where a template has
/// it. `canonical_from_template`: to the group's own frame, nm.
void set_orbits(DiscreteSites& sites, const std::vector<Eigen::Matrix3d>& group,
                const Pose& canonical_from_template);

/// Indices of sites that far more particles show than the others: more than five standard errors above their
/// median. A hot spot may be an artefact: particles whose labels are few are laid onto the brightest site.
/// Under a group each pose is one of its images, and which one is a convention that may gather labels: the
/// sites of an orbit are one place, and what is compared is their mean.
std::vector<std::size_t> hot_spots(const DiscreteSites& sites);

}  // namespace polar
