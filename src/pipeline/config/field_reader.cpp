#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

#include "fields.hpp"
#include "nearest.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
const Node kEmpty;
constexpr std::size_t kLongestShown = 60;

std::string at_line(const std::string& where, int line) {
  return line > 0 ? where + ":" + std::to_string(line) : where;
}

std::string shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "empty";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a section";
    case Node::Kind::scalar:
      break;
  }
  return "'" + node.scalar.substr(0, kLongestShown) + "'";
}
}  // namespace

FieldReader::FieldReader(const Node& map, std::string where, std::string prefix)
    : map_(map), where_(std::move(where)), prefix_(std::move(prefix)) {
  if (map.kind != Node::Kind::map && map.kind != Node::Kind::null)
    throw smlm::Error(smlm::Fault::usage, at_line(where_, map.line),
                      prefix_.empty() ? "a configuration is a map of sections"
                                      : prefix_.substr(0, prefix_.size() - 1) + " is " + shown(map),
                      "expected 'key: value' lines");
}

const Node* FieldReader::take(const char* name) {
  known_.emplace_back(name);
  for (const auto& [key, value] : map_.entries)
    if (key == name) return &value;
  return nullptr;
}

FieldReader FieldReader::enter(const char* name) {
  const Node* node = take(name);
  return {node ? *node : kEmpty, where_, prefix_ + name + "."};
}

void FieldReader::wrong(const Node& node, const std::string& name, const std::string& expected) const {
  throw smlm::Error(smlm::Fault::usage, at_line(where_, node.line), prefix_ + name + " is " + shown(node),
                    "expected " + expected);
}

template <class T>
T FieldReader::number(const Node& node, const std::string& name, const char* expected) const {
  T value{};
  const char *begin = node.scalar.data(), *end = begin + node.scalar.size();
  if (node.kind != Node::Kind::scalar || node.quoted) wrong(node, name, expected);
  const auto parsed = std::from_chars(begin, end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) wrong(node, name, expected);
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) wrong(node, name, expected);
  return value;
}

void FieldReader::field(const char* name, bool& value) {
  const Node* node = take(name);
  if (!node) return;
  const bool yes = node->scalar == "true";
  if (node->kind != Node::Kind::scalar || node->quoted || (!yes && node->scalar != "false"))
    wrong(*node, name, "true or false");
  value = yes;
}

void FieldReader::field(const char* name, int& value) {
  if (const Node* node = take(name)) value = number<int>(*node, name, "a whole number");
}

void FieldReader::field(const char* name, std::int64_t& value) {
  if (const Node* node = take(name)) value = number<std::int64_t>(*node, name, "a whole number");
}

void FieldReader::field(const char* name, std::uint64_t& value) {
  if (const Node* node = take(name)) value = number<std::uint64_t>(*node, name, "a whole number, 0 or more");
}

void FieldReader::field(const char* name, double& value) {
  if (const Node* node = take(name)) value = number<double>(*node, name, "a number");
}

void FieldReader::field(const char* name, std::string& value) {
  const Node* node = take(name);
  if (!node) return;
  if (node->kind != Node::Kind::scalar) wrong(*node, name, "text");
  value = node->scalar;
}

void FieldReader::field(const char* name, std::array<double, 2>& range) {
  const Node* node = take(name);
  if (!node) return;
  constexpr const char* kExpected = "a number or [low, high]";
  if (node->kind == Node::Kind::list) {
    if (node->items.size() != 2) wrong(*node, name, kExpected);
    range = {number<double>(node->items[0], name, kExpected),
             number<double>(node->items[1], name, kExpected)};
  } else {
    range[0] = range[1] = number<double>(*node, name, kExpected);
  }
}

void FieldReader::field(const char* name, std::vector<std::string>& list) {
  const Node* node = take(name);
  if (!node) return;
  constexpr const char* kExpected = "text or a list of texts";
  if (node->kind != Node::Kind::list && node->kind != Node::Kind::scalar) wrong(*node, name, kExpected);
  list.clear();
  if (node->kind == Node::Kind::scalar) list.push_back(node->scalar);
  for (const Node& item : node->items) {
    if (item.kind != Node::Kind::scalar) wrong(item, name, kExpected);
    list.push_back(item.scalar);
  }
}

void FieldReader::field(const char* name, std::vector<double>& list) {
  const Node* node = take(name);
  if (!node) return;
  constexpr const char* kExpected = "a number or a list of numbers";
  list.clear();
  if (node->kind != Node::Kind::list) list.push_back(number<double>(*node, name, kExpected));
  for (const Node& item : node->items) list.push_back(number<double>(item, name, kExpected));
}

double FieldReader::bound(const Node& node, const std::string& name) const {
  const double infinity = std::numeric_limits<double>::infinity();
  if (node.kind == Node::Kind::scalar && !node.quoted && node.scalar == ".inf") return infinity;
  if (node.kind == Node::Kind::scalar && !node.quoted && node.scalar == "-.inf") return -infinity;
  return number<double>(node, name, "[low, high], numbers or -.inf and .inf");
}

void FieldReader::bounds(const char* name, std::array<double, 2>& low_high) {
  const Node* node = take(name);
  if (!node) return;
  if (node->kind != Node::Kind::list || node->items.size() != 2) wrong(*node, name, "[low, high]");
  low_high = {bound(node->items[0], name), bound(node->items[1], name)};
}

void FieldReader::bounds(const char* name, std::map<std::string, std::array<double, 2>>& map) {
  FieldReader inner = enter(name);
  for (const auto& [key, value] : inner.map_.entries) inner.bounds(key.c_str(), map[key]);
}

void FieldReader::tree(const char* name, Node& map) {
  const Node* node = take(name);
  if (!node) return;
  if (node->kind != Node::Kind::map && node->kind != Node::Kind::null) wrong(*node, name, "a section");
  map = *node;
}

void FieldReader::finish() const {
  for (const auto& [key, value] : map_.entries) {
    bool known = false;
    for (const std::string& k : known_) known = known || k == key;
    if (known) continue;
    const bool number = !key.empty() && key.find_first_not_of("0123456789") == std::string::npos;
    if (number && value.kind == Node::Kind::null)
      throw smlm::Error(smlm::Fault::usage, at_line(where_, value.line),
                        "unknown key '" + prefix_ + key.substr(0, kLongestShown) + "'",
                        "is it the end of a number? Decimals follow a point, not a comma");
    const std::string near = nearest_word(key, known_);
    throw smlm::Error(smlm::Fault::usage, at_line(where_, value.line),
                      "unknown key '" + prefix_ + key.substr(0, kLongestShown) + "'",
                      near.empty() ? "" : "did you mean '" + prefix_ + near + "'?");
  }
}

}  // namespace polar::pipeline
