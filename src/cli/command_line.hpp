// The command as it was typed, for the record.
#pragma once

#include <string>

namespace polar::cli {

void remember_command(int argc, char** argv);

/// Words quoted where a shell would take them apart; empty before remember_command.
const std::string& command_line();

}  // namespace polar::cli
