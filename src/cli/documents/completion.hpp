// Completions out of the parser: commands, options, and the words that an option takes; files elsewhere.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace polar::cli {

/// For /usr/share/bash-completion/completions/polar; needs nothing but bash.
std::string bash_completion(const CLI::App& app);

/// For /usr/share/zsh/site-functions/_polar.
std::string zsh_completion(const CLI::App& app);

}  // namespace polar::cli
