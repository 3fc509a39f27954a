// polar: results on stdout, everything else on stderr, one line for an error; exit codes in docs/faults.md.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "app.hpp"
#include "command_line.hpp"
#include "last_words.hpp"
#include "smlm/error.hpp"

namespace {
// A program started with a closed stdin, stdout or stderr would give its number to the next file it opens,
// and print into a result.
void occupy_standard_streams() {
  while (true) {
    const int fd = ::open("/dev/null", O_RDWR);
    if (fd > STDERR_FILENO) ::close(fd);
    if (fd < 0 || fd > STDERR_FILENO) return;
  }
}

// Results on stdout that a full disk swallowed were not delivered.
int delivered(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  throw smlm::Error(smlm::Fault::io, "stdout", "could not be written",
                    "check the disk or pipe that it goes to");
}

int run_program(int argc, char** argv) {
  polar::cli::remember_command(argc, argv);
  polar::cli::Action action;
  const std::unique_ptr<CLI::App> app = polar::cli::make_app(action);
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app->exit(e);
  }
  return action();
}
}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  try {
    return polar::cli::ended(delivered(run_program(argc, argv)));
  } catch (...) {
    return polar::cli::ended(polar::cli::report_exception());
  }
}
