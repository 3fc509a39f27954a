// How much of the structure a view shows, where labels are missing and each blinks in its own way.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "problem.hpp"

namespace polar {

/// The number of spots of radius `reach` (of the unit of `points`, 3 x n) that the localisations `which`
/// occupy: their number squared over that of their pairs within reach, the participation ratio, in which a
/// bright spot counts little more than a dim one and a stray localisation little.
double occupied_spots(const Eigen::Matrix3Xf& points, const std::vector<std::uint32_t>& which, float reach);

/// At most `most` views, those with the most occupied spots first; looks at `subset` of each.
std::vector<int> fullest_views(const Problem& problem, const Subsets& subset, std::size_t most);

}  // namespace polar
