#pragma once

#include <string>
#include <vector>

namespace polar::pipeline {

/// What an absolute path with * ? [..] and ** (any number of folders, also none) stands for, sorted by name:
/// itself where it is the name of something, nothing where nothing matches. A part of the path that is the
/// name of something is that, whatever brackets it has. Hidden names and links to folders are not looked into
/// by ** and *.
std::vector<std::string> matching_paths(const std::string& pattern);

/// Files that would match if case did not matter, and do not.
std::vector<std::string> matching_but_for_case(const std::string& pattern);

}  // namespace polar::pipeline
