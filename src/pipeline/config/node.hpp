// A parsed configuration as plain data, with the line of every value. The only place that sees yaml-cpp is
// parse.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace polar::pipeline {

struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  int line = 0;         // 1-based; 0 for a value from the command line
  bool quoted = false;  // a quoted scalar is always text
  std::string scalar;
  std::vector<Node> items;
  std::vector<std::pair<std::string, Node>> entries;  // in the order of the file

  Node* find(const std::string& key);
};

/// What a configuration may be at most: far above any honest one, far below what hurts.
constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::size_t kMostDepth = 16;

/// Parses one YAML document. Duplicate keys, several documents, anchors and aliases are errors (usage) that
/// name `where` and the line.
Node parse_yaml(const std::string& text, const std::string& where);

/// Reads a regular file of at most kMostBytes.
Node load_yaml(const std::string& path);

/// Puts every value of `over` into `base`: maps are merged key by key, all else replaces what is there.
void merge(Node& base, const Node& over);

/// Puts `a.b.c=value` into the tree; the value is YAML ("[1, 2]", "true", plain text).
void apply_override(Node& root, const std::string& assignment);

}  // namespace polar::pipeline
