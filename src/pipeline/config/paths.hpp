#pragma once

#include <string>
#include <vector>

#include "polar/pipeline/run_config.hpp"

namespace polar::pipeline {

/// `path` as an absolute one: `~` is the home folder, anything relative starts at `folder`.
std::string resolve_path(const std::string& path, const std::string& folder);

/// Every pattern resolved and expanded (see matching_paths()); a pattern that matches nothing and a file
/// listed twice are errors (input and usage). `matched` gets what each pattern stood for.
std::vector<std::string> expand_files(const std::vector<std::string>& patterns, const std::string& folder,
                                      std::vector<MatchedPattern>* matched = nullptr);

/// The folder that holds `file`.
std::string folder_of(const std::string& file);

}  // namespace polar::pipeline
