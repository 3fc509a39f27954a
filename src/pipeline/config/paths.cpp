#include "paths.hpp"

#include <glob.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "smlm/error.hpp"

namespace polar::pipeline {

std::string folder_of(const std::string& file) {
  return std::filesystem::absolute(std::filesystem::path(file)).parent_path().string();
}

std::string resolve_path(const std::string& path, const std::string& folder) {
  if (path == "~" || path.rfind("~/", 0) == 0) {
    const char* home = std::getenv("HOME");
    if (!home || !*home)
      throw smlm::Error(smlm::Fault::usage, path, "HOME is not set", "write the path without ~");
    return home + path.substr(1);
  }
  const std::filesystem::path p = path;
  return (p.is_absolute() ? p : std::filesystem::path(folder) / p).lexically_normal().string();
}

std::vector<std::string> matching_paths(const std::string& pattern) {
  std::error_code ec;
  if (std::filesystem::exists(pattern, ec)) return {pattern};  // a name with brackets is still a name
  std::vector<std::string> paths;
  glob_t found{};
  const int status = ::glob(pattern.c_str(), 0, nullptr, &found);
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  return paths;
}

std::vector<std::string> expand_files(const std::vector<std::string>& patterns, const std::string& folder) {
  std::vector<std::string> files;
  for (const std::string& pattern : patterns) {
    const std::string path = resolve_path(pattern, folder);
    const std::vector<std::string> found = matching_paths(path);
    if (found.empty()) throw smlm::Error(smlm::Fault::input, path, "no such file", "correct input.files");
    files.insert(files.end(), found.begin(), found.end());
  }
  std::set<std::string> seen;
  for (const std::string& file : files)
    if (!seen.insert(file).second)
      throw smlm::Error(smlm::Fault::usage, "input.files", "'" + file + "' is listed twice",
                        "every localisation would count twice");
  return files;
}

}  // namespace polar::pipeline
