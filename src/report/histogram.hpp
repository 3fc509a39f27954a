// Values in bins of one width.
#pragma once

#include <cstddef>
#include <vector>

namespace polar::report {

struct Histogram {
  double low = 0, width = 1;
  std::vector<std::size_t> count;
  std::size_t total = 0;             // finite values
  std::size_t below = 0, above = 0;  // of them, outside: counted in the first and the last bin

  double edge(std::size_t bin) const { return low + width * static_cast<double>(bin); }
  double high() const { return edge(count.size()); }
  std::size_t highest() const;
};

/// Bins between round numbers that hold all finite values but at most the outermost 0.5 % on either side.
Histogram histogram(const std::vector<double>& values, std::size_t about_bins = 24);

/// Bins that are given; values outside are counted at the ends.
Histogram histogram_between(const std::vector<double>& values, double low, double high, std::size_t bins);

/// One bin a whole number from 0 or from the smallest; wider where there are more than `most_bins`.
Histogram whole_number_histogram(const std::vector<double>& values, std::size_t most_bins = 40);

/// The finite ones, sorted; numbers that no quantity here can have (1e30) count as none.
std::vector<double> sorted_finite(std::vector<double> values);

/// 1, 2 or 5 times a power of ten, the least that is not below `least`.
double round_step(double least);

}  // namespace polar::report
