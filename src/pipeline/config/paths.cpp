#include "paths.hpp"

#include <cstdlib>
#include <filesystem>
#include <set>

#include "glob.hpp"
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

namespace {
[[noreturn]] void refuse_missing(const std::string& pattern, const std::string& path) {
  // In double quotes YAML makes a tab of the letters \\t.
  const bool windows = pattern.find_first_of("\\\t") != std::string::npos;
  const bool variable = pattern.find('$') != std::string::npos;
  const bool braces = pattern.find('{') != std::string::npos;
  const std::vector<std::string> other_case = matching_but_for_case(path);
  throw smlm::Error(
      smlm::Fault::input, path, "no such file",
      windows    ? "folders are separated by / (\\ is a letter of a name, and in double quotes \\t is a tab)"
      : variable ? "variables are not replaced: write the path, or ~ for your home"
      : braces   ? "braces are no pattern: list the files, or use *"
      : !other_case.empty() ? "but for upper and lower case there is '" + other_case.front() + "'"
                            : "correct input.files");
}
}  // namespace

std::vector<std::string> expand_files(const std::vector<std::string>& patterns, const std::string& folder,
                                      std::vector<MatchedPattern>* matched) {
  std::vector<std::string> files;
  for (const std::string& pattern : patterns) {
    const std::string path = resolve_path(pattern, folder);
    std::vector<std::string> found = matching_paths(path);
    // A link that leads nowhere is there by its name: opening it says what is wrong.
    std::error_code ignored;
    if (found.empty() && std::filesystem::is_symlink(std::filesystem::symlink_status(path, ignored)))
      found = {path};
    if (found.empty()) refuse_missing(pattern, path);
    files.insert(files.end(), found.begin(), found.end());
    if (matched && pattern.find_first_of("*?[") != std::string::npos)
      matched->push_back({pattern, found.size(), matching_but_for_case(path)});
  }
  std::set<std::string> seen;
  for (const std::string& file : files)
    if (!seen.insert(file).second)
      throw smlm::Error(smlm::Fault::usage, "input.files", "'" + file + "' is listed twice",
                        "every localisation would count twice");
  return files;
}

}  // namespace polar::pipeline
