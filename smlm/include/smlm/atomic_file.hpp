// Files that appear whole or not at all: written under a temporary name in the same folder, synced, renamed.
#pragma once

#include <string>
#include <string_view>

namespace smlm {

/// Holds a temporary name beside `final_path`. Any writer fills the temporary file and closes it, then
/// commit() makes it the final one. Without commit() the temporary file is removed and the final name keeps
/// what it had. Throws Error(io) that names the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(std::string final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary_path() const { return temporary_path_; }
  const std::string& final_path() const { return final_path_; }

  /// fsync of the file, rename, fsync of the folder. A failed fsync is final: it is never tried again.
  void commit();

 private:
  std::string final_path_;
  std::string temporary_path_;
  bool committed_ = false;
};

/// Writes `content` to `path` through AtomicFile; short writes and EINTR are continued.
void write_file_atomically(const std::string& path, std::string_view content);

}  // namespace smlm
