#include "model_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "config/nearest.hpp"
#include "config/node.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace polar::pipeline {

namespace {
using fitting::Expression;
using fitting::GeometricModel;
using fitting::ModelParameter;

constexpr const char* kExtension = ".yaml";
constexpr std::size_t kMostParts = 64;

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& w : words) list += (list.empty() ? "" : ", ") + w;
  return list;
}

// Reads one file; every fault names its line and key.
class ModelReader {
 public:
  ModelReader(const std::string& where, const Eigen::Matrix3Xd& site_nm) : where_(where), site_nm_(site_nm) {}

  GeometricModel read(const Node& root) {
    check_keys(root, "", {"name", "about", "parameters", "parts", "derived"});
    model_ = fitting::empty_model();
    model_.name = text(member(root, "name", ""), "name");
    if (const Node* about = find(root, "about")) model_.about = text(*about, "about");
    read_parameters(member(root, "parameters", ""));
    const Node& parts = member(root, "parts", "");
    if (parts.kind != Node::Kind::list || parts.items.empty() || parts.items.size() > kMostParts)
      fail(parts, "parts", "is not a list of 1 to " + std::to_string(kMostParts) + " parts");
    for (std::size_t i = 0; i < parts.items.size(); ++i)
      read_part(parts.items[i], "parts[" + std::to_string(i + 1) + "]");
    if (const Node* derived = find(root, "derived")) read_derived(*derived);
    return model_;
  }

 private:
  [[noreturn]] void fail(const Node& node, const std::string& key, const std::string& what,
                         const std::string& remedy = {}) const {
    throw smlm::Error(smlm::Fault::usage, node.line > 0 ? where_ + ":" + std::to_string(node.line) : where_,
                      key.empty() ? what : key + " " + what, remedy);
  }

  static const Node* find(const Node& map, const std::string& key) {
    for (const auto& [name, value] : map.entries)
      if (name == key) return &value;
    return nullptr;
  }
  const Node& member(const Node& map, const std::string& key, const std::string& prefix) const {
    const Node* found = find(map, key);
    if (!found) fail(map, prefix + key, "is missing");
    return *found;
  }
  void check_keys(const Node& map, const std::string& prefix, const std::vector<std::string>& known) const {
    if (map.kind != Node::Kind::map)
      fail(map, prefix.empty() ? "a model" : prefix, "is not a map", "expected 'key: value' lines");
    for (const auto& [key, value] : map.entries)
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(value, (prefix.empty() ? "" : prefix + ".") + key, "is not known",
             "did you mean '" + nearest_word(key, known) + "'? (known: " + listed(known) + ")");
  }
  std::string text(const Node& node, const std::string& key) const {
    if (node.kind != Node::Kind::scalar || node.scalar.empty()) fail(node, key, "is not a text");
    return node.scalar;
  }
  Expression formula(const Node& node, const std::string& key, const std::vector<std::string>& names) const {
    if (node.kind != Node::Kind::scalar) fail(node, key, "is not a number or a formula");
    try {
      return Expression(node.scalar, names);
    } catch (const std::invalid_argument& e) {
      fail(node, key, std::string("is no formula: ") + e.what());
    }
  }
  double number(const Node& node, const std::string& key) const {
    const double value = formula(node, key, {}).at(std::vector<double>{});
    if (!std::isfinite(value)) fail(node, key, "is not finite");
    return value;
  }
  void check_name(const Node& node, const std::string& key, const std::string& name) const {
    const bool word =
        !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    if (!word || name == "pi" || name == "extent")
      fail(node, key, "is no name for a quantity", "letters, digits and _, not pi or extent");
  }

  void read_parameters(const Node& map) {
    if (map.kind != Node::Kind::map) fail(map, "parameters", "is not a map of parameters");
    for (const auto& [name, node] : map.entries) {
      const std::string key = "parameters." + name;
      check_name(node, key, name);
      check_keys(node, key, {"unit", "start", "bounds", "about", "shared"});
      ModelParameter p;
      p.name = name;
      p.unit = text(member(node, "unit", key + "."), key + ".unit");
      if (const Node* about = find(node, "about")) p.about = text(*about, key + ".about");
      const Node& start = member(node, "start", key + ".");
      for (const Node& one : start.kind == Node::Kind::list ? start.items : std::vector<Node>{start})
        p.start.push_back(formula(one, key + ".start", {"extent"}));
      if (p.start.empty()) fail(start, key + ".start", "is empty");
      const Node& bounds = member(node, "bounds", key + ".");
      if (bounds.kind != Node::Kind::list || bounds.items.size() != 2)
        fail(bounds, key + ".bounds", "is not [low, high]");
      p.low = number(bounds.items[0], key + ".bounds"), p.high = number(bounds.items[1], key + ".bounds");
      if (!(p.low < p.high)) fail(bounds, key + ".bounds", "is not [low, high] with low below high");
      if (const Node* shared = find(node, "shared")) {
        if (shared->scalar != "true" && shared->scalar != "false")
          fail(*shared, key + ".shared", "is '" + shared->scalar + "'", "expected true or false");
        p.shared = shared->scalar == "true";
      }
      if ((name == "width" && !(p.low > 0)) || (name == "background" && !(p.low >= 0 && p.high < 1)))
        fail(bounds, key + ".bounds", name == "width" ? "must be above 0" : "must lie in [0, 1)");
      add(node, key, p);
    }
  }
  void add(const Node& node, const std::string& key, const ModelParameter& p) {
    for (ModelParameter& known : model_.parameter)
      if (known.name == p.name) {  // width or background, as this model wants them
        known = p;
        return;
      }
    if (model_.parameter.size() == fitting::kMostModelParameters)
      fail(node, key, "is one too many",
           "a model has at most " + std::to_string(fitting::kMostModelParameters - 2) +
               " parameters of its own");
    model_.parameter.push_back(p);
  }

  void read_part(const Node& node, const std::string& key) {
    std::vector<std::string> known = {"share"};
    for (const auto& s : fitting::shapes()) known.emplace_back(s.name);
    check_keys(node, key, known);
    fitting::Part part;
    int found = 0;
    for (const auto& s : fitting::shapes())
      if (const Node* arguments = find(node, s.name)) {
        ++found;
        read_arguments(*arguments, key + "." + s.name, s, part);
      }
    if (found != 1)
      fail(node, key, "names " + std::to_string(found) + " primitives", "a part is one of them");
    if (const Node* share = find(node, "share")) part.share = formula(*share, key + ".share", model_.names());
    model_.part.push_back(part);
  }
  void read_arguments(const Node& map, const std::string& key, const fitting::ShapeSpecification& s,
                      fitting::Part& part) {
    std::vector<std::string> known(s.arguments.begin(), s.arguments.end());
    known.insert(known.end(), fitting::placement_arguments().begin(), fitting::placement_arguments().end());
    if (s.shape == fitting::Shape::ring) known.emplace_back("units");
    static const Node kNothing = [] {
      Node n;
      n.kind = Node::Kind::map;
      return n;
    }();
    const Node& arguments = map.kind == Node::Kind::null ? kNothing : map;
    check_keys(arguments, key, known);
    part.shape = s.shape;
    for (const char* a : s.arguments)
      part.argument.push_back(formula(member(arguments, a, key + "."), key + "." + a, model_.names()));
    for (const char* a : fitting::placement_arguments()) {
      const Node* given = find(arguments, a);
      part.placement.push_back(given ? formula(*given, key + "." + a, model_.names()) : Expression(0.0));
    }
    if (const Node* units = find(arguments, "units")) {
      const double n = number(*units, key + ".units");
      if (!(n >= 0 && n <= 1000 && n == std::floor(n)))
        fail(*units, key + ".units", "is no whole number from 0 (all around) to 1000");
      part.units = static_cast<int>(n);
    }
    if (s.shape != fitting::Shape::sites) return;
    if (site_nm_.cols() == 0) fail(map, key, "needs sites", "name a table of x, y, z with --sites");
    part.site_nm = site_nm_;
  }

  void read_derived(const Node& map) {
    if (map.kind != Node::Kind::map) fail(map, "derived", "is not a map of quantities");
    for (const auto& [name, node] : map.entries) {
      const std::string key = "derived." + name;
      check_name(node, key, name);
      check_keys(node, key, {"unit", "value", "about"});
      const auto names = model_.names();
      if (std::find(names.begin(), names.end(), name) != names.end())
        fail(node, key, "is a parameter already");
      fitting::DerivedQuantity d;
      d.name = name;
      d.unit = text(member(node, "unit", key + "."), key + ".unit");
      if (const Node* about = find(node, "about")) d.about = text(*about, key + ".about");
      d.value = formula(member(node, "value", key + "."), key + ".value", names);
      model_.derived.push_back(d);
    }
  }

  std::string where_;
  const Eigen::Matrix3Xd& site_nm_;
  GeometricModel model_;
};
}  // namespace

std::vector<std::string> shipped_models() {
  std::vector<std::string> names;
  for (const auto& [file, text] : embedded_texts())
    names.push_back(file.substr(0, file.size() - std::string(kExtension).size()));
  return names;
}

GeometricModel parse_model(const std::string& text, const std::string& where,
                           const Eigen::Matrix3Xd& site_nm) {
  return ModelReader(where, site_nm).read(parse_yaml(text, where));
}

GeometricModel load_model(const std::string& model, const Eigen::Matrix3Xd& site_nm) {
  const auto shipped = embedded_texts().find(model + kExtension);
  if (shipped != embedded_texts().end()) return parse_model(shipped->second, "model " + model, site_nm);
  std::error_code unseen;
  if (!std::filesystem::exists(model, unseen))
    throw smlm::Error(smlm::Fault::usage, "--model", "'" + model + "' is neither a shipped model nor a file",
                      "shipped: " + listed(shipped_models()));
  return ModelReader(model, site_nm).read(load_yaml(model));
}

void hold_parameter(GeometricModel& model, const std::string& assignment) {
  const std::string where = "--hold " + assignment;
  const std::size_t equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals);
  const auto p = std::find_if(model.parameter.begin(), model.parameter.end(),
                              [&](const ModelParameter& known) { return known.name == name; });
  if (p == model.parameter.end())
    throw smlm::Error(smlm::Fault::usage, where, "no such parameter", "known: " + listed(model.names()));
  p->fixed = true;
  p->start.resize(1);
  if (equals == std::string::npos) return;
  try {
    p->start[0] = Expression(assignment.substr(equals + 1), {});
  } catch (const std::invalid_argument& e) {
    throw smlm::Error(smlm::Fault::usage, where, e.what());
  }
  const double value = p->start[0].at(std::vector<double>{});
  if (!(value >= p->low && value <= p->high))
    throw smlm::Error(smlm::Fault::usage, where, "outside of the parameter's bounds",
                      "at least " + smlm::number_text(p->low) + ", at most " + smlm::number_text(p->high));
}

}  // namespace polar::pipeline
