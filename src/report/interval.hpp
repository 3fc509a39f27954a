// A range that holds a share with a probability of 95 %.
#pragma once

namespace polar::report {

struct Interval {
  double low = 0, high = 1;
};

/// Of a share found in n trials (E. B. Wilson, J. Am. Stat. Assoc. 22, 209-212, 1927).
Interval wilson(double share, double n);

}  // namespace polar::report
