#include "name_index.hpp"

#include <iterator>

namespace smlm {

std::int64_t NameIndex::of_text(std::string_view text) {
  if (last_ >= 0 && name(last_) == text) return last_;
  const auto found = by_name_.find(text);
  if (found != by_name_.end()) {
    last_ = found->second;
  } else {
    last_ = static_cast<std::int64_t>(names_.size());
    names_.emplace_back(text);
    by_name_.emplace(names_.back(), last_);
  }
  return last_;
}

std::vector<std::string> NameIndex::take() {
  by_name_.clear();
  last_ = -1;
  return {std::make_move_iterator(names_.begin()), std::make_move_iterator(names_.end())};
}

}  // namespace smlm
