#include "checkpoint_store.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "polar/core/isa.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
constexpr int kLeastWorkPerWriting = 50;  // times as long: checkpoints cost 2 % at most

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    throw smlm::Error(smlm::Fault::io, path, "cannot be read", "check its permissions");
  return bytes;
}
}  // namespace

const std::vector<std::string>& checkpoint_files() {
  static const std::vector<std::string> names = {"checkpoint.1", "checkpoint.2"};
  return names;
}

CheckpointStore::CheckpointStore(const OutputDirectory& directory, ComputationIdentity identity)
    : directory_(directory) {
  content_.identity = std::move(identity);
  content_.instructions = name(active_isa());
}

bool CheckpointStore::resume(Progress& progress) {
  std::vector<std::string> unreadable;
  CheckpointContent newest;
  std::string of;
  for (const std::string& file : checkpoint_files()) {
    const std::string path = directory_.file(file);
    if (!std::filesystem::exists(path)) continue;
    CheckpointContent found;
    try {
      found = parse_checkpoint(content_of(path), path);
    } catch (const smlm::Error& e) {
      unreadable.emplace_back(e.what());
      continue;
    }
    require_same_computation(found, content_.identity, path);
    if (!of.empty() && found.number < newest.number) continue;
    newest = std::move(found);
    of = path;
  }
  if (of.empty()) {
    if (unreadable.empty()) return false;
    throw smlm::Error(smlm::Fault::input, "", unreadable.front(), kComputeAgain);
  }
  for (const std::string& reason : unreadable)
    progress.note("warning: " + reason + "; continuing from " + of + " instead");
  if (newest.instructions != content_.instructions)
    progress.note("warning: begun with " + newest.instructions + " instructions and continued with " +
                  content_.instructions + ": last digits may differ from a run on one machine");
  content_.states = std::move(newest.states);
  content_.number = newest.number;
  progress.note("continuing from " + of);
  return true;
}

std::optional<std::string> CheckpointStore::load(const std::string& name) {
  const auto found = content_.states.find(name);
  if (found == content_.states.end()) return std::nullopt;
  return found->second;
}

void CheckpointStore::keep(const std::string& name, std::string bytes) {
  content_.states[name] = std::move(bytes);
  dirty_ = true;
  if (Clock::now() - last_end_ >= kLeastWorkPerWriting * last_took_) flush();
}

void CheckpointStore::drop(const std::string& prefix) {
  auto& states = content_.states;
  auto at = states.lower_bound(prefix);
  while (at != states.end() && at->first.compare(0, prefix.size(), prefix) == 0) at = states.erase(at);
}

bool CheckpointStore::flush() {
  if (dirty_) {
    const Clock::time_point begin = Clock::now();
    ++content_.number;
    const std::size_t slot = content_.number % checkpoint_files().size();
    smlm::write_file_atomically(directory_.file(checkpoint_files()[slot]), format_checkpoint(content_));
    dirty_ = false;
    last_end_ = Clock::now();
    last_took_ = last_end_ - begin;
  }
  return content_.number > 0;
}

void CheckpointStore::remove() {
  for (const std::string& file : checkpoint_files()) {
    std::error_code ignored;  // a complete result makes it meaningless
    std::filesystem::remove(directory_.file(file), ignored);
  }
}

}  // namespace polar::pipeline
