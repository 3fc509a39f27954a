// polar: results on stdout, everything else on stderr, one line for an error; exit codes in docs/faults.md.
#include <cstdio>
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
}  // namespace

int main(int argc, char** argv) {
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
    return action();
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
    return report(std::string("unexpected: ") + e.what() + ": please report this", 1);
  }
}
