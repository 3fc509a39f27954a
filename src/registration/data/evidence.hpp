// The one notion of evidence: log densities of localisations that were not fitted, one number a view; two
// hypotheses are compared view by view.
#pragma once

#include <vector>

namespace polar {

/// Mean log density per held-out localisation of every view; NaN for a view that says nothing.
using Evidence = std::vector<double>;

/// Mean over the views that say something; 0 of none.
double mean_evidence(const Evidence& evidence);

/// Of the same views by several draws of what judges: each view's mean over the draws where it says
/// something.
Evidence mean_over(const std::vector<Evidence>& draws);

/// How much better `b` is than `a`: mean of the paired differences and its standard error over views.
struct Comparison {
  double gain = 0, standard_error = 0;
  int views = 0;
  /// Whether b is better by so many standard errors (0: at all; negative: not worse by so many).
  bool better_by(double standard_errors) const {
    return views > 0 && gain > standard_errors * standard_error;
  }
};
Comparison compare(const Evidence& a, const Evidence& b);

}  // namespace polar
