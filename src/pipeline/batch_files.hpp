// The files that `polar batch` writes beside the folders of its data sets.
#pragma once

#include <string>

#include "polar/pipeline/outputs.hpp"

namespace polar::pipeline {

constexpr const char* kBatchSummary = "summary.csv";
constexpr const char* kBatchConditions = "conditions.csv";
constexpr const char* kBatchState = "batch.json";

inline bool is_batch_file(const std::string& name) {
  return name == kBatchSummary || name == kBatchConditions || name == kBatchState ||
         name == kReportFile;
}

}  // namespace polar::pipeline
