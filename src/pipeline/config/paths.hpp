#pragma once

#include <string>
#include <vector>

namespace polar::pipeline {

/// `path` as an absolute one: `~` is the home folder, anything relative starts at `folder`.
std::string resolve_path(const std::string& path, const std::string& folder);

/// What an absolute path with * ? [..] stands for, sorted by name: itself where it is the name of something,
/// nothing where nothing matches.
std::vector<std::string> matching_paths(const std::string& pattern);

/// Every pattern resolved and expanded (* ? [..], sorted by name); a pattern that matches nothing and a file
/// listed twice are errors (input and usage).
std::vector<std::string> expand_files(const std::vector<std::string>& patterns, const std::string& folder);

/// The folder that holds `file`.
std::string folder_of(const std::string& file);

}  // namespace polar::pipeline
