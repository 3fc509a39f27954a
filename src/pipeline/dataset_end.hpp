// What a process that runs a data set of a batch leaves when there is no result: how that ended, for the
// process that makes the tables.
#pragma once

#include <optional>
#include <string>

namespace polar::pipeline {

struct DatasetEnd {
  bool stopped = false;  // asked to; else it failed
  int exit_code = 0;     // that `polar run` would have ended with
  std::string reason;
};

/// Into a file of its name below `folder`, which is made. Where that cannot be written there is no word of
/// it.
void write_dataset_end(const std::string& folder, const std::string& name, const DatasetEnd& end);

/// Nothing where none was left.
std::optional<DatasetEnd> read_dataset_end(const std::string& folder, const std::string& name);

void remove_dataset_end(const std::string& folder, const std::string& name);

}  // namespace polar::pipeline
