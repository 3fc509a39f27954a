#include "polar/pipeline/version.hpp"

#include <Eigen/Core>

#include "polar/core/isa.hpp"

namespace polar {

std::string program_version() { return "polar " POLAR_VERSION " (commit " POLAR_COMMIT ")"; }

std::vector<std::string> library_versions() {
  return {"Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
              std::to_string(EIGEN_MINOR_VERSION),
          std::string("instruction set ") + name(active_isa()), "compiler " __VERSION__};
}

}  // namespace polar
