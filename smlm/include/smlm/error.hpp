// The one error type of the project: what is wrong, where, and what to do, in one line.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace smlm {

/// The value is the process's exit code (docs/faults.md).
enum class Fault { usage = 2, input = 3, io = 4, numerical = 5, resource = 6 };

class Error : public std::runtime_error {
 public:
  /// Reads as "<where>: <what>: <remedy>"; an empty part is left out. `where` is a file with its line or
  /// field, or a configuration key.
  Error(Fault fault, const std::string& where, const std::string& what, const std::string& remedy = {})
      : std::runtime_error(join(join(where, what), remedy)), fault_(fault) {}

  Fault fault() const { return fault_; }
  int exit_code() const { return static_cast<int>(fault_); }

 private:
  static std::string join(const std::string& a, const std::string& b) {
    return a.empty() ? b : b.empty() ? a : a + ": " + b;
  }
  Fault fault_;
};

/// All faults of one place in one line, so that they are mended together; nothing where there are none.
inline void throw_if_any(const std::vector<std::string>& faults, Fault fault, const std::string& where) {
  std::string all;
  for (const std::string& f : faults) all += (all.empty() ? "" : "; ") + f;
  if (!all.empty()) throw Error(fault, where, all);
}

}  // namespace smlm
