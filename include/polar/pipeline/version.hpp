#pragma once

#include <string>
#include <vector>

namespace polar {

/// "polar 0.1.0 (commit abc1234)".
std::string program_version();

/// The libraries that numbers depend on, as found at run time.
std::vector<std::string> library_versions();

}  // namespace polar
