// The page of a batch: a row a data set, and a strip plot a number with its conditions side by side.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace polar {

struct BatchDataset {
  std::string name, condition, state, reason;
  std::string symmetry;
  std::map<std::string, double> number;  // by the column's name in summary.csv; only those that are there
  std::string link;                      // its own page, relative to the batch's; empty: there is none
  std::string thumbnail_png;             // empty: nothing to show
};

/// The mean of a condition and its interval (NaN: none), or its difference from another condition.
struct BatchMean {
  std::string measure, condition, minus;
  double mean = 0, low = 0, high = 0;
};

struct BatchRecord {
  std::string program;
  std::vector<BatchDataset> datasets;
  std::vector<BatchMean> means;
};

/// Reads batch.json and conditions.csv, and the records of the data sets, each in the folder of its name, for
/// their thumbnails. Throws smlm::Error (input) where batch.json is none.
BatchRecord read_batch_record(const std::string& folder);

std::string batch_page(const BatchRecord& batch, const std::string& name);

/// Reads the batch in `folder` and writes its page to `html`, whole or not at all. Throws smlm::Error.
void write_batch_report(const std::string& folder, const std::string& html, const std::string& name);

}  // namespace polar
