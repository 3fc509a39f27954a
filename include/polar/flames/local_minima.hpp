// FLAMES (paper III.E.a): the local minima of a cost over a rotation grid.
#pragma once

#include <vector>

#include "polar/flames/neighbour_graph.hpp"

namespace polar {

/// Grid nodes whose cost is lower than at all their neighbours (ties go to the lower index), the
/// `most` cheapest of them, cheapest first. NaN costs are never minima.
std::vector<int> local_minima(const std::vector<float>& cost, const NeighbourGraph& graph, int most);

}  // namespace polar
