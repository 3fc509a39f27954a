#include "polar/pipeline/batch_config.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "batch_files.hpp"
#include "config/fields.hpp"
#include "config/glob.hpp"
#include "config/paths.hpp"
#include "run_config_tree.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using pipeline::Node;

// One entry of `datasets`: a data set, or a pattern that stands for one of every folder.
struct Entry {
  std::string name, folders, condition;
  std::vector<std::string> input;
  Node overrides;
};

struct Tree {
  BatchConfig config;
  Node defaults;
  std::vector<Entry> entries;
};

void fields(pipeline::FieldReader& v, Tree& t) {
  v.tree("defaults", t.defaults);
  v.items("datasets", t.entries, [](pipeline::FieldReader& s, Entry& e) {
    s.field("name", e.name);
    s.field("folders", e.folders);
    s.field("condition", e.condition);
    s.field("input", e.input);
    s.tree("overrides", e.overrides);
  });
  v.section("bootstrap", [&](pipeline::FieldReader& s) {
    s.field("draws", t.config.bootstrap.draws);
    s.field("level", t.config.bootstrap.level);
    s.field("seed", t.config.bootstrap.seed);
  });
  v.section("output", [&](pipeline::FieldReader& s) { s.field("directory", t.config.directory); });
}

// A name becomes a folder.
bool can_be_a_folder(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos && !pipeline::is_batch_file(name);
}

void check(const Tree& t, const std::string& path) {
  std::vector<std::string> faults;
  if (t.entries.empty()) faults.emplace_back("datasets is missing: list {name, input} or {folders, input}");
  for (std::size_t i = 0; i < t.entries.size(); ++i) {
    const Entry& e = t.entries[i];
    const std::string key = "datasets[" + std::to_string(i + 1) + "]";
    if (e.name.empty() == e.folders.empty())
      faults.push_back(key + " needs either name, for one data set, or folders, for one of every folder");
    if (!e.name.empty() && !can_be_a_folder(e.name))
      faults.push_back(key + ".name is '" + e.name + "', expected the name of a folder");
    if (e.input.empty()) faults.push_back(key + ".input is missing: list its localisation tables");
  }
  for (const std::string& v : violations(t.config.bootstrap)) faults.push_back("bootstrap." + v);
  if (t.config.directory.empty()) faults.emplace_back("output.directory is empty");
  smlm::throw_if_any(faults, smlm::Fault::usage, path);
}

Node text_node(const std::string& text) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.quoted = true;
  node.scalar = text;
  return node;
}

Node map_node() {
  Node node;
  node.kind = Node::Kind::map;
  return node;
}

// The directory is the batch's to choose, the files are the data set's.
void refuse_own_keys(Node& tree, const std::string& of, const std::string& path) {
  const std::pair<const char*, const char*> keys[] = {{"output", "directory"}, {"input", "files"}};
  for (const auto& [section, key] : keys) {
    Node* const inner = tree.find(section);
    const Node* found = inner ? inner->find(key) : nullptr;
    if (found)
      throw smlm::Error(smlm::Fault::usage, path + ":" + std::to_string(found->line),
                        of + " holds " + section + "." + key,
                        std::string(key) == "files" ? "give the tables as input of the data set"
                                                    : "results go to a folder of the data set's name");
  }
}

// What a set's run is made of: defaults, its own overrides, files, and the command line's.
Node run_tree(const Tree& t, const Entry& e, const std::vector<std::string>& files,
              const std::vector<std::string>& overrides) {
  Node root = t.defaults.kind == Node::Kind::map ? t.defaults : map_node();
  if (e.overrides.kind == Node::Kind::map) pipeline::merge(root, e.overrides);
  Node list, input = map_node(), whole = map_node();
  list.kind = Node::Kind::list;
  for (const std::string& file : files) list.items.push_back(text_node(file));
  input.entries.emplace_back("files", list);
  whole.entries.emplace_back("input", input);
  pipeline::merge(root, whole);
  for (const std::string& assignment : overrides) pipeline::apply_override(root, assignment);
  return root;
}

DatasetConfig dataset(const Tree& t, const Entry& e, std::vector<std::string> files,
                      const std::vector<std::string>& overrides, const std::string& path) {
  DatasetConfig d;
  d.name = e.name;
  d.condition = e.condition;
  const std::string folder = pipeline::folder_of(path);
  try {
    d.run = pipeline::run_config_of(run_tree(t, e, files, overrides), path, folder);
  } catch (const smlm::Error& error) {
    if (error.fault() != smlm::Fault::input) throw;
    d.fault = error.what();
    d.fault_code = error.exit_code();
  }
  return d;
}

// One entry a folder. What the pattern's wildcards stand for gives the name, "wild_type/cell_3" becoming
// "wild_type_cell_3", and where there are several levels the first is the condition.
std::vector<std::pair<Entry, std::string>> entries_of_folders(const Entry& e, const std::string& path) {
  const std::string folder = pipeline::folder_of(path);
  const std::string pattern = pipeline::resolve_path(e.folders, folder);
  std::filesystem::path fixed;
  for (const auto& part : std::filesystem::path(pattern)) {
    if (part.string().find_first_of("*?[") != std::string::npos) break;
    fixed /= part;
  }
  std::vector<std::pair<Entry, std::string>> found;
  std::error_code unseen;
  for (const std::string& match : pipeline::matching_paths(pattern)) {
    if (!std::filesystem::is_directory(match, unseen)) continue;
    const std::filesystem::path relative = std::filesystem::path(match).lexically_relative(fixed);
    Entry one = e;
    std::vector<std::string> parts;
    for (const auto& part : relative)
      if (!part.empty() && part != ".") parts.push_back(part.string());
    if (parts.empty()) parts.push_back(std::filesystem::path(match).filename().string());
    for (const std::string& part : parts) one.name += (one.name.empty() ? "" : "_") + part;
    if (one.condition.empty() && parts.size() > 1) one.condition = parts.front();
    found.emplace_back(std::move(one), match);
  }
  if (found.empty())
    throw smlm::Error(smlm::Fault::usage, path, "datasets: no folder matches '" + e.folders + "'",
                      "correct the pattern");
  return found;
}

void require_distinct_names(const std::vector<DatasetConfig>& datasets, const std::string& path) {
  std::set<std::string> seen;
  for (const DatasetConfig& d : datasets) {
    if (!can_be_a_folder(d.name))
      throw smlm::Error(smlm::Fault::usage, path, "'" + d.name + "' cannot be the name of a data set",
                        "rename the folder, or name the data set");
    if (!seen.insert(d.name).second)
      throw smlm::Error(smlm::Fault::usage, path, "two data sets are called '" + d.name + "'",
                        "their results would lie in one folder");
  }
}
}  // namespace

std::vector<std::string> violations(const BootstrapOptions& options) {
  std::vector<std::string> faults;
  constexpr int kFewest = 100, kMost = 10000000;
  if (options.draws < kFewest || options.draws > kMost)
    faults.push_back("draws must be from " + std::to_string(kFewest) + " to " + std::to_string(kMost));
  if (!(options.level > 0 && options.level < 1)) faults.emplace_back("level must be between 0 and 1");
  return faults;
}

BatchConfig load_batch_config(const std::string& path, const std::vector<std::string>& overrides) {
  const Node root = pipeline::load_yaml(path);
  Tree t;
  pipeline::FieldReader reader(root, path);
  fields(reader, t);
  reader.finish();
  check(t, path);
  refuse_own_keys(t.defaults, "defaults", path);
  for (Entry& e : t.entries) refuse_own_keys(e.overrides, "overrides", path);
  for (const Entry& e : t.entries) {
    if (e.folders.empty()) {
      t.config.datasets.push_back(dataset(t, e, e.input, overrides, path));
      continue;
    }
    for (const auto& [one, folder] : entries_of_folders(e, path)) {
      std::vector<std::string> files;
      for (const std::string& file : one.input) files.push_back(pipeline::resolve_path(file, folder));
      t.config.datasets.push_back(dataset(t, one, std::move(files), overrides, path));
    }
  }
  require_distinct_names(t.config.datasets, path);
  move_batch(t.config, pipeline::resolve_path(t.config.directory, pipeline::folder_of(path)));
  return std::move(t.config);
}

void move_batch(BatchConfig& config, const std::string& directory) {
  config.directory = directory;
  for (DatasetConfig& d : config.datasets) d.run.output.directory = directory + "/" + d.name;
}

}  // namespace polar
