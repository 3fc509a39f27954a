// What the parser knows of an option, in the words of a manual.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace polar::cli {

/// In the order of declaration; --help of the program itself too.
std::vector<const CLI::Option*> flags_of(const CLI::App& app);
std::vector<const CLI::Option*> positionals_of(const CLI::App& app);
std::vector<const CLI::App*> subcommands_of(const CLI::App& app);

/// "-h", "--help": as they are typed.
std::vector<std::string> spellings(const CLI::Option& option);

bool takes_value(const CLI::Option& option);

/// The words that alone are valid; empty where any is.
std::vector<std::string> choices(const CLI::Option& option);

}  // namespace polar::cli
