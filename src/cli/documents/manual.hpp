// Manual pages out of the parser: what --help says, as man(7).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace polar::cli {

/// polar(1): the subcommands and the exit codes. `version` is what --version says.
std::string manual(const CLI::App& app, const std::string& version);

/// polar-run(1) and its like.
std::string manual_of(const CLI::App& subcommand, const std::string& version);

}  // namespace polar::cli
