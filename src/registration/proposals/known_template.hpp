// A structure that is known beforehand, as a start: poses are annealed under a density drawn from its sites.
// And how much of an average could be that structure's own.
#pragma once

#include <string>
#include <vector>

#include "../anneal/soft_poses.hpp"
#include "polar/registration/register.hpp"

namespace polar {

/// The sites about their centroid, each as bright as its weight, blurred by `width`.
DensityGrid density_of(const KnownTemplate& known, const VoxelFrame& frame, double scale_nm, double width);

/// A state with that density and no poses yet.
SoftState known_state(const KnownTemplate& known, const VoxelFrame& frame, const Problem& problem,
                      double width, double outlier_fraction);

/// Correlations with the known template of what is posed on it once, without the means over shells about the
/// centre: those are the same whatever the poses are.
struct Likeness {
  double particles = 0;
  // Of the same particles with every localisation turned about its particle's centre at random.
  double noise = 0;
  /// Of the particles' likeness, what noise shows too.
  double own_share() const;
};
Likeness likeness_to_known(const Problem& problem, const std::vector<int>& which,
                           const RegistrationOptions& options);

std::string warning_of(const Likeness& likeness);

}  // namespace polar
