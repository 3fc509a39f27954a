#include "polar/model/shipped_weights.hpp"

#include <filesystem>
#include <vector>

#include "smlm/error.hpp"

namespace polar {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "polar_autoencoder_1.h5";

std::vector<fs::path> places() {
  std::vector<fs::path> found;
  std::error_code ignored;  // a system without /proc has the other places
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty())
    found.push_back(program.parent_path().parent_path() / "share" / "polar-smlm" / "weights" / kFile);
  found.push_back(fs::path(POLAR_INSTALLED_WEIGHTS) / kFile);
  found.push_back(fs::path("/usr/share/polar-smlm/weights") / kFile);  // of a package
  found.push_back(fs::path(POLAR_SOURCE_WEIGHTS) / kFile);
  return found;
}

}  // namespace

std::string weights_path(const std::string& configured) {
  std::error_code ignored;
  if (!configured.empty()) {
    if (fs::is_regular_file(configured, ignored)) return configured;
    throw smlm::Error(smlm::Fault::usage, "registration.weights", "there is no file '" + configured + "'",
                      "leave the key out for the weights that ship, or train some with `polar train`");
  }
  std::string tried;
  for (const fs::path& place : places()) {
    if (fs::is_regular_file(place, ignored)) return place.string();
    tried += (tried.empty() ? "" : ", ") + place.string();
  }
  throw smlm::Error(smlm::Fault::usage, "registration.weights", "the weights that ship are not at " + tried,
                    "name a file, or take polar out of registration.starts (and use method: likelihood)");
}

}  // namespace polar
