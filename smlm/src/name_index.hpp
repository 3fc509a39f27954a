// Numbers the distinct names of a column, in order of first appearance.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace smlm {

class NameIndex {
 public:
  /// Names are compared as text: "1", "1.0" and "01" are three.
  std::int64_t of_text(std::string_view text);

  std::size_t size() const { return names_.size(); }
  const std::string& name(std::int64_t index) const { return names_[static_cast<std::size_t>(index)]; }
  std::vector<std::string> take();

 private:
  std::deque<std::string> names_;  // never moves a name, so that the map can look into it
  std::unordered_map<std::string_view, std::int64_t> by_name_;
  std::int64_t last_ = -1;  // rows of one particle mostly follow each other
};

}  // namespace smlm
