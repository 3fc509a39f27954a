#include "output_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "checkpoint_store.hpp"
#include "polar/pipeline/outputs.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
constexpr const char* kLock = ".polar.lock";

[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& remedy) {
  throw smlm::Error(smlm::Fault::io, path, what, remedy);
}

// What a run in which no particle has a pose leaves is its page, the record and the poses that go with it,
// without a summary: nothing to be kept from the same command given again.
bool holds_something(const std::string& path) {
  bool something = false, page = false;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    if (name == kLock) continue;
    if (name != kReportFile && name != "results.h5" && name != "poses.csv") return true;
    something = true;
    page = page || name == kReportFile;
  }
  return something && !page;
}

std::vector<std::string> our_files() {
  std::vector<std::string> names = result_files();
  names.insert(names.end(), checkpoint_files().begin(), checkpoint_files().end());
  return names;
}
}  // namespace

OutputDirectory::OutputDirectory(const std::string& path, const RunFlags& flags)
    : path_(path), lock_path_(file(kLock)) {
  std::error_code ec;
  std::filesystem::create_directories(path, ec);
  std::error_code unseen;
  if (!std::filesystem::is_directory(path, unseen)) {
    const bool in_the_way = std::filesystem::exists(path, unseen);
    fail(path, in_the_way ? "is not a directory" : "cannot be created: " + (ec ? ec : unseen).message(),
         "choose another output.directory");
  }
  lock_ = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0)
    fail(path, std::string("cannot be written: ") + std::strerror(errno), "choose another output.directory");
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock_);
    fail(path, "another process is writing here", "wait for it, or choose another output.directory");
  }
  remove_leftovers();
  if (!flags.overwrite && !flags.resume && holds_something(path)) {
    ::close(lock_);
    fail(path, "is not empty", "give --overwrite or --resume, or choose another output.directory");
  }
}

OutputDirectory::~OutputDirectory() {
  ::unlink(lock_path_.c_str());  // while it is still locked: nobody else can hold this name
  ::close(lock_);
}

void OutputDirectory::remove_leftovers() const {
  const std::string end = ".tmp";
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < end.size() || name.compare(name.size() - end.size(), end.size(), end) != 0) continue;
    for (const std::string& ours : our_files())
      if (name.compare(0, ours.size() + 2, "." + ours + ".") == 0) {
        std::error_code ignored;
        std::filesystem::remove(entry.path(), ignored);
      }
  }
}

void OutputDirectory::remove_other_results(const std::vector<std::string>& written) const {
  for (const std::string& name : result_files()) {
    if (std::find(written.begin(), written.end(), name) != written.end()) continue;
    std::error_code ignored;  // what cannot be removed will be reported by whoever replaces it
    std::filesystem::remove(file(name), ignored);
  }
}

}  // namespace polar::pipeline
