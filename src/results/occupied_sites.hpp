// Which sites a particle shows: the fewest that explain its localisations.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar::results {

/// `density`: localisations x sites, the density of each localisation at each site; `background`: the same of
/// the background, times its share. Shares of the sites are fitted to the particle (expectation
/// maximisation), then every site goes, the weakest first, without which the log likelihood falls by less
/// than 2: an uncertain localisation between two sites belongs to the one that is there anyway, a single one
/// that is near no other site keeps its own.
/// `odds`: log of how much more often a site is there than not; 0: nothing is known of it.
std::vector<std::size_t> occupied_sites(const Eigen::MatrixXd& density, double background, double odds = 0);

}  // namespace polar::results
