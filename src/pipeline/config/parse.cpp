#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "node.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
[[noreturn]] void fail(const std::string& where, int line, const std::string& what,
                       const std::string& remedy = {}) {
  throw smlm::Error(smlm::Fault::usage, line > 0 ? where + ":" + std::to_string(line) : where, what, remedy);
}

// Builds the tree from the parser's events, so that nothing is ever expanded or followed.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string where) : where_(std::move(where)) {}

  Node root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, anchor, {}); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(where_, mark.line + 1, "an alias", "write the value itself");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node;
    node.kind = Node::Kind::scalar;
    node.quoted = tag == "!";
    node.scalar = value;
    const bool empty = !node.quoted && (value == "~" || value == "null");
    if (empty && !expects_key()) node.kind = Node::Kind::null;
    add(mark, anchor, std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor, Node::Kind::list);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor, Node::Kind::map);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Level {
    Node* node;
    bool has_key = false;
    std::string key = {};
  };

  bool expects_key() const {
    return !open_.empty() && open_.back().node->kind == Node::Kind::map && !open_.back().has_key;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Node::Kind kind) {
    if (open_.size() >= kMostDepth)
      fail(where_, mark.line + 1, "nested deeper than " + std::to_string(kMostDepth) + " levels");
    if (expects_key()) fail(where_, mark.line + 1, "a key must be plain text");
    Node node;
    node.kind = kind;
    // A node's address is stable while it is open: its siblings come only after it is closed.
    open_.push_back({add(mark, anchor, std::move(node))});
  }

  Node* add(const YAML::Mark& mark, YAML::anchor_t anchor, Node node) {
    const int line = mark.line + 1;
    if (anchor != YAML::NullAnchor) fail(where_, line, "an anchor", "write the value out where it is needed");
    node.line = line;
    if (open_.empty()) {
      root = std::move(node);
      return &root;
    }
    Level& level = open_.back();
    if (level.node->kind == Node::Kind::list) {
      level.node->items.push_back(std::move(node));
      return &level.node->items.back();
    }
    if (!level.has_key) {
      if (node.kind != Node::Kind::scalar) fail(where_, line, "a key must be plain text");
      if (level.node->find(node.scalar))
        fail(where_, line, "key '" + node.scalar + "' occurs twice", "keep one of them");
      level.key = node.scalar;
      level.has_key = true;
      return nullptr;
    }
    level.has_key = false;
    level.node->entries.emplace_back(level.key, std::move(node));
    return &level.node->entries.back().second;
  }

  std::string where_;
  std::vector<Level> open_;
};
}  // namespace

namespace {
// What a line that is no YAML most likely has in it.
std::string remedy_for(const std::string& text, int line) {
  std::istringstream in(text);
  std::string content;
  for (int i = 0; i <= line && std::getline(in, content); ++i) {
  }
  const auto first = content.find_first_not_of(" \t");
  if (first != std::string::npos && content.find('\t') < first) return "a tab: YAML is indented with blanks";
  if (content.find('"') != std::string::npos && content.find('\\') != std::string::npos)
    return "a backslash in double quotes: separate folders by /, or write the path in single quotes";
  return {};
}
}  // namespace

Node* Node::find(const std::string& key) {
  for (auto& [name, value] : entries)
    if (name == key) return &value;
  return nullptr;
}

Node parse_yaml(const std::string& text, const std::string& where) {
  Builder builder(where);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    parser.HandleNextDocument(builder);
    Builder second(where);
    if (parser.HandleNextDocument(second))
      fail(where, second.root.line, "a second YAML document", "keep one");
  } catch (const YAML::Exception& e) {
    fail(where, e.mark.line + 1, "not valid YAML: " + e.msg, remedy_for(text, e.mark.line));
  }
  return builder.root;
}

Node load_yaml(const std::string& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (ec || !std::filesystem::exists(status))
    fail(path, 0, "no such file", "give the path of a YAML configuration");
  if (!std::filesystem::is_regular_file(status)) fail(path, 0, "not a regular file");
  if (std::filesystem::file_size(path, ec) > kMostBytes)
    fail(path, 0, "larger than " + std::to_string(kMostBytes) + " bytes", "this is no configuration");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) fail(path, 0, "cannot be read");
  return parse_yaml(text.str(), path);
}

void merge(Node& base, const Node& over) {
  if (base.kind != Node::Kind::map || over.kind != Node::Kind::map) {
    if (over.kind != Node::Kind::null || base.kind != Node::Kind::map) base = over;
    return;
  }
  for (const auto& [key, value] : over.entries) {
    if (Node* known = base.find(key))
      merge(*known, value);
    else
      base.entries.emplace_back(key, value);
  }
}

void apply_override(Node& root, const std::string& assignment) {
  const std::string where = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) fail(where, 0, "expected section.key=value");
  Node* at = &root;
  std::istringstream path(assignment.substr(0, equals));
  for (std::string key; std::getline(path, key, '.');) {
    if (at->kind == Node::Kind::null) at->kind = Node::Kind::map;
    if (at->kind != Node::Kind::map || key.empty()) fail(where, 0, "no such key");
    Node* next = at->find(key);
    if (!next) {
      at->entries.emplace_back(key, Node{});
      next = &at->entries.back().second;
    }
    at = next;
  }
  *at = parse_yaml(assignment.substr(equals + 1), where);
  at->line = 0;
}

}  // namespace polar::pipeline
