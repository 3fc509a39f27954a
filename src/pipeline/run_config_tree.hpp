#pragma once

#include <string>

#include "config/node.hpp"
#include "polar/pipeline/run_config.hpp"

namespace polar::pipeline {

/// A run's configuration out of a parsed tree, checked, with its paths resolved against `folder`; `where` is
/// named by its faults (see load_run_config).
RunConfig run_config_of(const Node& root, const std::string& where, const std::string& folder);

}  // namespace polar::pipeline
