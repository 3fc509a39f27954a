// MATLAB 5 files as plain values. The only user of libmatio.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace smlm {

/// A variable, a cell or a field. Numbers of every type and Booleans become doubles, column-major.
struct MatValue {
  enum class Kind { none, numbers, cells, structure };
  Kind kind = Kind::none;
  std::vector<std::size_t> dims;
  std::vector<double> numbers;
  std::vector<MatValue> cells;
  std::map<std::string, MatValue> fields;  // of a 1 x 1 struct

  const MatValue& field(const std::string& name) const;  // Kind::none when absent
};

bool is_mat_v5(const std::string& beginning);

/// The names of the variables; empty when the file cannot be listed.
std::vector<std::string> mat_v5_variables(const std::string& path);

/// Throws Error(input) when the file or the variable cannot be read.
MatValue read_mat_v5(const std::string& path, const std::string& variable);

}  // namespace smlm
