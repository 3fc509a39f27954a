// polar: results on stdout, everything else on stderr, one line for an error; exit codes in docs/faults.md.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "command.hpp"
#include "polar/pipeline/version.hpp"
#include "smlm/error.hpp"

namespace {
constexpr int kUsage = static_cast<int>(smlm::Fault::usage);
constexpr int kResource = static_cast<int>(smlm::Fault::resource);

int report(const std::string& what, int code) {
  std::string line = what;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  std::fprintf(stderr, "error: %s\n", line.c_str());
  return code;
}

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
}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  CLI::App app{"polar: aligns copies of one structure in localisation microscopy"};
  app.set_version_flag("--version", polar::program_version());
  app.require_subcommand(1);
  polar::cli::Action action;
  polar::cli::add_run(app, action);
  polar::cli::add_simulate(app, action);
  polar::cli::add_export(app, action);
  polar::cli::add_evaluate(app, action);
  polar::cli::add_inspect(app, action);
  polar::cli::add_train(app, action);
  try {
    app.parse(argc, argv);
    return delivered(action());
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::Error& e) {
    return report(std::string(e.what()) + ": see polar --help", kUsage);
  } catch (const smlm::Error& e) {
    return report(e.what(), e.exit_code());
  } catch (const std::bad_alloc&) {
    return report("out of memory: use fewer localisations, a coarser output.voxel_nm or a larger machine",
                  kResource);
  } catch (const std::exception& e) {
    // Threads are made by a library that says so only in words.
    if (std::strstr(e.what(), "pthread_create") != nullptr)
      return report(
          "no thread could be started: raise the limit on memory or processes, or use fewer --threads",
          kResource);
    return report(std::string("unexpected: ") + e.what() + ": please report this", 1);
  }
}
