// Numbers the distinct names or numbers of a column, in order of first appearance.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace smlm {

class NameIndex {
 public:
  /// "3", "3.0" and the number 3 are the same name; any other text is itself.
  std::int64_t of_text(std::string_view text);
  std::int64_t of_number(double value);

  const std::vector<std::string>& names() const { return names_; }
  std::vector<std::string> take() { return std::move(names_); }

 private:
  std::int64_t insert(const std::string& name);

  std::vector<std::string> names_;
  std::unordered_map<std::string, std::int64_t> by_name_;
  std::unordered_map<double, std::int64_t> by_number_;
  double last_number_ = 0;
  std::int64_t last_index_ = -1;  // of last_number_; rows of one particle mostly follow each other
};

/// The shortest decimal text of a number, the same in every locale: "3", "0.5".
std::string number_text(double value);

}  // namespace smlm
