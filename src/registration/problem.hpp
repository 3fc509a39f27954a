// What every stage of a registration shares: the views, the axes of their uncertainties, and which
// localisations are fitted, which judge.
#pragma once

#include <cstdint>
#include <vector>

#include "polar/core/view.hpp"
#include "polar/fusion/cuts.hpp"
#include "polar/fusion/fusion_data.hpp"

namespace polar {

struct Problem {
  const Views& views;
  std::vector<Eigen::Vector3f> axes;
  Subsets shuffled;  // all localisations of each view in a keyed random order: any prefix is a sample
  Subsets fitted;    // the share the template is fitted to while anything is still chosen by likelihood
  Subsets held_out;  // the rest: judges starts, calibration and the number of centres
  std::vector<ViewReach> reach;  // of every view; not in the plane
  std::vector<int> all;
  std::uint64_t seed = 1;
  double localisations = 0;

  bool planar() const { return views.planar; }
  std::size_t size() const { return views.view.size(); }
};

/// Both ways to see one set of views. Thinning takes away strands, and with them dense detail that tells one
/// side of a structure from the other; a start believes in one of the two, and they compete.
struct Problems {
  Problem thinned, plain;
  const Problem& of(bool crowded) const { return crowded ? thinned : plain; }
};

/// Samples of `thinned` are even (evenness.hpp), and what is too dense is left out of its `fitted`.
/// Localisations that are held out are the same, and even, in both.
Problems make_problems(const Views& views, std::uint64_t seed);

/// At most `most` views, evenly through the set: neighbours may share a field of view.
std::vector<int> some_views(const Problem& problem, std::size_t most);

/// The median length of the lists of the views `which`; 0 of none.
std::size_t median_size(const Subsets& subsets, const std::vector<int>& which);

/// The first `most` of every list.
Subsets first_of(const Subsets& subsets, std::size_t most);

}  // namespace polar
