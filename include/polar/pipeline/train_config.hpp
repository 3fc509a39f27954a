// The configuration of `polar train` (configs/train.yaml has every key).
#pragma once

#include <string>
#include <vector>

#include "polar/model/train_options.hpp"

namespace polar {

/// Reads the file, applies `section.key=value` overrides, resolves paths against the file's folder and checks
/// everything. Throws smlm::Error (usage), or (input) for shape files that are not there.
TrainOptions load_train_options(const std::string& path, const std::vector<std::string>& overrides);

/// The same configuration as YAML text, every key written.
std::string train_options_text(const TrainOptions& options);

}  // namespace polar
