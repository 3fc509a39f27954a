// What a subcommand is: it declares its arguments on the parser, and runs once they are parsed.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace polar::cli {

/// Set by the subcommand that was given: does the work, returns the exit code.
using Action = std::function<int()>;

void add_run(CLI::App& app, Action& action);
void add_apply(CLI::App& app, Action& action);
void add_batch(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_fit(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_inspect(CLI::App& app, Action& action);
void add_train(CLI::App& app, Action& action);

}  // namespace polar::cli
