// Where a long computation leaves the states it reaches, and finds those of a run that was cut short. This
// one keeps nothing.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace polar {

class Checkpoint {
 public:
  virtual ~Checkpoint() = default;
  /// The bytes that the same computation kept under this name before it was cut short.
  virtual std::optional<std::string> load(const std::string& name) {
    (void)name;
    return std::nullopt;
  }
  /// Keeps a state from which the rest follows, bit for bit. Called from the thread that runs the
  /// registration; may throw smlm::Error (io).
  // NOLINTNEXTLINE(performance-unnecessary-value-param): for overrides to move from
  virtual void keep(const std::string& name, std::string bytes) { (void)name, (void)bytes; }
  /// No state whose name begins so will be asked for again.
  virtual void drop(const std::string& prefix) { (void)prefix; }
};

/// A part of another, for a computation that happens several times in a run.
class PartOfCheckpoint : public Checkpoint {
 public:
  PartOfCheckpoint(Checkpoint& whole, std::string name) : whole_(whole), prefix_(std::move(name) + "/") {}
  std::optional<std::string> load(const std::string& name) override { return whole_.load(prefix_ + name); }
  void keep(const std::string& name, std::string bytes) override {
    whole_.keep(prefix_ + name, std::move(bytes));
  }
  void drop(const std::string& prefix) override { whole_.drop(prefix_ + prefix); }

 private:
  Checkpoint& whole_;
  std::string prefix_;
};

}  // namespace polar
