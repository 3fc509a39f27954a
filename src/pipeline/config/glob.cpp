#include "glob.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>

namespace polar::pipeline {

namespace {
namespace fs = std::filesystem;
constexpr int kDeepest = 64;

// Walks down the parts of a pattern.
class Walk {
 public:
  Walk(const fs::path& pattern, int flags)
      : parts_(pattern.begin(), pattern.end()), flags_(flags | FNM_PERIOD) {}

  std::vector<std::string> paths() {
    from({}, 0, 0);
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

 private:
  static bool has_wildcard(const std::string& part) { return part.find_first_of("*?[") != std::string::npos; }

  static std::vector<fs::path> children(const fs::path& folder) {
    std::error_code unreadable;
    std::vector<fs::path> all;
    for (fs::directory_iterator it(folder, unreadable), end; !unreadable && it != end;
         it.increment(unreadable))
      all.push_back(it->path());
    return all;
  }

  void from(const fs::path& folder, std::size_t part, int depth) {
    std::error_code unseen;
    if (part == parts_.size()) {
      found_.push_back(folder.string());
      return;
    }
    const std::string& name = parts_[part].native();
    if (name == "**" && part + 1 < parts_.size()) {
      from(folder, part + 1, depth);
      if (depth >= kDeepest) return;
      for (const fs::path& child : children(folder)) {
        if (child.filename().native().front() == '.') continue;
        if (fs::is_directory(child, unseen) && !fs::is_symlink(child, unseen)) from(child, part, depth + 1);
      }
      return;
    }
    if (!has_wildcard(name) || fs::exists(folder / name, unseen)) {
      if (fs::exists(folder / name, unseen)) from(folder / name, part + 1, depth);
      return;
    }
    for (const fs::path& child : children(folder))
      if (::fnmatch(name.c_str(), child.filename().c_str(), flags_) == 0) from(child, part + 1, depth);
  }

  std::vector<fs::path> parts_;
  int flags_;
  std::vector<std::string> found_;
};
}  // namespace

std::vector<std::string> matching_paths(const std::string& pattern) { return Walk(pattern, 0).paths(); }

std::vector<std::string> matching_but_for_case(const std::string& pattern) {
  const std::vector<std::string> exact = matching_paths(pattern);
  std::vector<std::string> loose = Walk(pattern, FNM_CASEFOLD).paths(), more;
  std::set_difference(loose.begin(), loose.end(), exact.begin(), exact.end(), std::back_inserter(more));
  return more;
}

}  // namespace polar::pipeline
