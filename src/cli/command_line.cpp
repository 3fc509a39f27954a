#include "command_line.hpp"

#include "pipeline/shell_text.hpp"

namespace polar::cli {

namespace {
std::string remembered;
}  // namespace

void remember_command(int argc, char** argv) { remembered = pipeline::shell_words({argv, argv + argc}); }

const std::string& command_line() { return remembered; }

}  // namespace polar::cli
