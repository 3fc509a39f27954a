// The command line as one parser: what main parses, and what manual pages and completions are made from.
#pragma once

#include <memory>

#include "command.hpp"

namespace polar::cli {

/// With every subcommand; the one that is given sets `action`, which must outlive the parser.
std::unique_ptr<CLI::App> make_app(Action& action);

}  // namespace polar::cli
