// Means of conditions and their differences, with intervals from drawing the data sets again.
#pragma once

#include <string>
#include <vector>

#include "polar/pipeline/batch_config.hpp"

namespace polar::pipeline {

/// One number of one data set.
struct Observation {
  std::string condition;
  double value = 0;
};

/// The mean of a condition, or how far it is above that of `other`.
struct ConditionMean {
  std::string condition, other;    // other empty: the mean itself
  std::size_t datasets = 0;        // of the condition
  std::size_t other_datasets = 0;  // of the other one
  double mean = 0;
  double low = 0, high = 0;  // NaN where a condition has a single data set
};

/// Every condition in the order of its first data set, then every pair of them. Data sets are drawn with
/// repetition; a percentile interval of the mean of n values is too narrow by sqrt((n - 1) / n), and is
/// widened by that (T. Hesterberg, What teachers should know about the bootstrap, The American Statistician
/// 69, 371-386, 2015). Observations that are NaN are left out. `item` keeps the draws of several numbers
/// apart.
std::vector<ConditionMean> condition_means(const std::vector<Observation>& observations,
                                           const BootstrapOptions& options, std::uint64_t item);

}  // namespace polar::pipeline
