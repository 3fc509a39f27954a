#include "name_index.hpp"

#include <array>
#include <charconv>

namespace smlm {

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::int64_t NameIndex::insert(const std::string& name) {
  const auto [found, inserted] = by_name_.emplace(name, static_cast<std::int64_t>(names_.size()));
  if (inserted) names_.push_back(name);
  return found->second;
}

std::int64_t NameIndex::of_number(double value) {
  if (last_index_ >= 0 && value == last_number_) return last_index_;
  const auto found = by_number_.find(value);
  last_index_ = found != by_number_.end() ? found->second : insert(number_text(value));
  if (found == by_number_.end()) by_number_.emplace(value, last_index_);
  last_number_ = value;
  return last_index_;
}

std::int64_t NameIndex::of_text(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && end == text.data() + text.size() && value - value == 0;
  return number ? of_number(value) : insert(std::string(text));
}

}  // namespace smlm
