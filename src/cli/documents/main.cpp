// Writes manual pages and completions into a folder when the program is built: polar_documents FOLDER.
#include <cstdio>
#include <fstream>

#include "cli/app.hpp"
#include "completion.hpp"
#include "description.hpp"
#include "manual.hpp"
#include "polar/pipeline/version.hpp"

namespace {
bool write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) std::fprintf(stderr, "%s: cannot be written\n", path.c_str());
  return bool(file);
}
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: polar_documents FOLDER\n", stderr), 2;
  const std::string folder = std::string(argv[1]) + "/", version = polar::program_version();
  polar::cli::Action unused;
  const auto app = polar::cli::make_app(unused);
  bool written = write(folder + "polar.1", polar::cli::manual(*app, version)) &&
                 write(folder + "polar.bash", polar::cli::bash_completion(*app)) &&
                 write(folder + "_polar", polar::cli::zsh_completion(*app));
  for (const CLI::App* command : polar::cli::subcommands_of(*app))
    written = written &&
              write(folder + "polar-" + command->get_name() + ".1", polar::cli::manual_of(*command, version));
  return written ? 0 : 1;
}
