// Binds YAML to option structs through one list of fields per struct: the same list reads a file, names its
// unknown keys and writes the effective configuration back.
//
//   template <class Visitor> void fields(Visitor& v, Options& o) { v.field("seed", o.seed); ... }
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "node.hpp"

namespace polar::pipeline {

/// Fills structs from a tree. finish() must be called on every level: it reports the keys that nobody asked
/// for. All errors are smlm::Error (usage) that name file, line and full key.
class FieldReader {
 public:
  FieldReader(const Node& map, std::string where, std::string prefix = {});

  void field(const char* name, bool& value);
  void field(const char* name, int& value);
  void field(const char* name, std::int64_t& value);
  void field(const char* name, std::uint64_t& value);
  void field(const char* name, double& value);
  void field(const char* name, std::string& value);
  void field(const char* name, std::array<double, 2>& range);    // [low, high], or one number for both
  void field(const char* name, std::vector<std::string>& list);  // a list, or one value
  void field(const char* name, std::vector<double>& list);
  void bounds(const char* name, std::array<double, 2>& low_high);  // [low, high], also -.inf and .inf
  void bounds(const char* name, std::map<std::string, std::array<double, 2>>& map);  // of the user's keys

  /// A nested map; `body` is called with a reader of it (of an empty one where the key is absent).
  template <class Body>
  void section(const char* name, Body body) {
    FieldReader inner = enter(name);
    body(inner);
    inner.finish();
  }
  /// A map with keys of the user's choice; `body(reader, value)` for each.
  template <class Value, class Body>
  void entries(const char* name, std::map<std::string, Value>& map, Body body) {
    const FieldReader outer = enter(name);
    for (const auto& [key, value] : outer.map_.entries) {
      FieldReader inner(value, where_, outer.prefix_ + key + ".");
      body(inner, map[key]);
      inner.finish();
    }
  }
  /// A list of maps, or one map; `body(reader, value)` for each.
  template <class Value, class Body>
  void items(const char* name, std::vector<Value>& list, Body body) {
    const Node* node = take(name);
    if (!node) return;
    if (node->kind != Node::Kind::list && node->kind != Node::Kind::map) wrong(*node, name, "a list");
    const bool one = node->kind == Node::Kind::map;
    for (std::size_t i = 0; i < (one ? 1 : node->items.size()); ++i) {
      FieldReader inner(one ? *node : node->items[i], where_,
                        prefix_ + name + "[" + std::to_string(i + 1) + "].");
      list.emplace_back();
      body(inner, list.back());
      inner.finish();
    }
  }
  /// A map that somebody else reads.
  void tree(const char* name, Node& map);
  void finish() const;

 private:
  FieldReader enter(const char* name);
  const Node* take(const char* name);
  double bound(const Node& node, const std::string& name) const;
  [[noreturn]] void wrong(const Node& node, const std::string& name, const std::string& expected) const;
  template <class T>
  T number(const Node& node, const std::string& name, const char* expected) const;

  const Node& map_;
  std::string where_, prefix_;
  std::vector<std::string> known_;
};

/// Writes the same fields as YAML text.
class FieldWriter {
 public:
  void field(const char* name, bool value);
  void field(const char* name, int value);
  void field(const char* name, std::int64_t value);
  void field(const char* name, std::uint64_t value);
  void field(const char* name, double value);
  void field(const char* name, const std::string& value);
  void field(const char* name, const std::array<double, 2>& range);
  void field(const char* name, const std::vector<std::string>& list);
  void field(const char* name, const std::vector<double>& list);
  void bounds(const char* name, const std::array<double, 2>& low_high);
  void bounds(const char* name, const std::map<std::string, std::array<double, 2>>& map);

  template <class Body>
  void section(const char* name, Body body) {
    line(std::string(name) + ":");
    ++depth_;
    body(*this);
    --depth_;
  }
  template <class Value, class Body>
  void entries(const char* name, std::map<std::string, Value>& map, Body body) {
    if (map.empty()) return line(std::string(name) + ": {}");
    section(name, [&](FieldWriter& outer) {
      for (auto& [key, value] : map)
        outer.section(key.c_str(), [&, &mapped = value](FieldWriter& inner) { body(inner, mapped); });
    });
  }
  const std::string& text() const { return text_; }

 private:
  void line(const std::string& content);
  std::string text_;
  int depth_ = 0;
};

}  // namespace polar::pipeline
