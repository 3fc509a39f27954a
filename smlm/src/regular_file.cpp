#include "smlm/regular_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "smlm/error.hpp"

namespace smlm {

std::uint64_t require_regular_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    throw Error(Fault::io, path, std::strerror(errno), "check the name and the permissions");
  if (!S_ISREG(status.st_mode))
    throw Error(Fault::input, path, "is not a regular file", "give files, not folders or devices");
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace smlm
