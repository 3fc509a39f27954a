// What every stage of a registration shares: the views, the axes of their uncertainties, and which
// localisations are fitted, which judge.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "evidence.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/registration/engine_options.hpp"

namespace polar {

struct Problem {
  const Views& views;
  std::vector<Eigen::Vector3f> axes;
  Subsets shuffled;  // all localisations of each view in a keyed random order: any prefix is a sample
  Subsets sampled;   // those that templates are fitted to once nothing is judged; the first are a sample
  Subsets fitted;    // of these, the bursts that templates are fitted to while something is judged
  Subsets held_out;  // of the other bursts, a few localisations of each: they judge
  std::vector<std::vector<int>> burst;  // of every localisation (bursts.hpp)
  std::vector<int> all;
  // Samples are thinned because strands are expected: centres need the support of many views.
  bool crowded = false;
  NoiseModel noise;  // by whose factors bursts are told apart
  std::uint64_t seed = 1;
  double localisations = 0;

  bool planar() const { return views.planar; }
  std::size_t size() const { return views.view.size(); }
};

/// Both ways to see one set of views. Thinning takes away strands, and with them dense detail that tells one
/// side of a structure from the other; hypotheses of both compete.
struct Problems {
  Problem thinned, plain;
  const Problem& of(bool crowded) const { return crowded ? thinned : plain; }
};

/// Samples of `thinned` are even (evenness.hpp), and what is too dense is left out of its `fitted`.
/// Localisations that are held out are the same in both.
Problems make_problems(const Views& views, const EvidenceOptions& options, std::uint64_t seed,
                       const NoiseModel& noise = {});

/// Other bursts judge: those of this draw, by the seed of the problem. The same in both problems of a set.
void hold_out(const EvidenceOptions& options, std::uint64_t draw, Problem& problem);

/// Of each view's evidence by so many draws the mean, or by fewer once `enough` says so of those that there
/// are; `judge` looks at the problem, which is left with the last.
Evidence over_draws(const EvidenceOptions& options, int draws, Problem& problem,
                    const std::function<Evidence()>& judge,
                    const std::function<bool(const std::vector<Evidence>&)>& enough = {});

/// At most `most` of them, evenly through the list: neighbours may share a field of view.
std::vector<int> evenly(const std::vector<int>& views, std::size_t most);

/// A share of them, rounded up, in a random order.
std::vector<int> share_at_random(const std::vector<int>& views, double share, KeyedRandom random);

/// The first `most` of every list.
Subsets first_of(const Subsets& subsets, std::size_t most);

}  // namespace polar
