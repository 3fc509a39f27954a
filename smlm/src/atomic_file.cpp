#include "smlm/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "smlm/error.hpp"

namespace smlm {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& action, int error) {
  throw Error(Fault::io, path, action + " failed (" + std::strerror(error) + ")",
              "check space, permissions and that the folder exists");
}

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

// Closes on every path out; close() errors matter only on the success path, which calls close itself.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
  int close() { return ::close(std::exchange(fd, -1)); }
};

int open_retrying(const std::string& path, int flags, mode_t mode = 0) {
  int fd = -1;
  do {
    fd = ::open(path.c_str(), flags | O_CLOEXEC, mode);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

// Messages call it `shown`.
void sync(const std::string& path, int flags, const std::string& shown) {
  Descriptor file{open_retrying(path, flags)};
  if (file.fd < 0) fail(shown, "opening it to sync", errno);
  if (::fsync(file.fd) != 0) fail(shown, "fsync", errno);
  if (file.close() != 0) fail(shown, "close", errno);
}

}  // namespace

AtomicFile::AtomicFile(std::string final_path) : final_path_(std::move(final_path)) {
  const auto slash = final_path_.rfind('/');
  const std::string name = slash == std::string::npos ? final_path_ : final_path_.substr(slash + 1);
  const std::string stem = folder_of(final_path_) + "/." + name + "." + std::to_string(::getpid()) + ".";
  for (int attempt = 0;; ++attempt) {
    temporary_path_ = stem + std::to_string(attempt) + ".tmp";
    // O_EXCL: a name planted by somebody else, a link for instance, is never followed.
    Descriptor file{open_retrying(temporary_path_, O_WRONLY | O_CREAT | O_EXCL, 0666)};
    if (file.fd >= 0) return;
    if (errno != EEXIST || attempt == 99) fail(final_path_, "creating a temporary file beside it", errno);
  }
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_path_.c_str());
}

void AtomicFile::commit() {
  sync(temporary_path_, O_RDONLY, final_path_);
  if (std::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) fail(final_path_, "rename", errno);
  committed_ = true;
  sync(folder_of(final_path_), O_RDONLY | O_DIRECTORY, folder_of(final_path_));
}

void write_file_atomically(const std::string& path, std::string_view content) {
  AtomicFile atomic(path);
  {
    Descriptor file{open_retrying(atomic.temporary_path(), O_WRONLY | O_TRUNC)};
    if (file.fd < 0) fail(path, "open", errno);
    while (!content.empty()) {
      const ssize_t written = ::write(file.fd, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        fail(path, "writing the last " + std::to_string(content.size()) + " bytes", errno);
      }
      content.remove_prefix(static_cast<std::size_t>(written));
    }
    if (file.close() != 0) fail(path, "close", errno);
  }
  atomic.commit();
}

}  // namespace smlm
