#include "missing.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace smlm {

bool is_missing(std::string_view text) {
  if (text.empty()) return true;
  constexpr std::size_t longest = 12;
  if (text.size() > longest) return false;
  std::string lower;
  for (const char c : text) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::string_view word = lower;
  if (word.front() == '-' || word.front() == '+') word.remove_prefix(1);
  constexpr std::array<std::string_view, 18> words{
      "nan",    "nan(ind)", "nan(snan)", "1.#ind", "1.#qnan", "1.#snan", "#ind",    "#qnan",  "na",
      "n/a",    "n.a.",     "#n/a",      "<na>",   "none",    "null",    "missing", "#value!", "#num!"};
  return word.empty() || std::find(words.begin(), words.end(), word) != words.end();
}

bool names_no_particle(std::string_view id, const std::vector<std::string>& stated) {
  if (is_missing(id)) return true;
  double number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  const bool numeric = error == std::errc() && end == id.data() + id.size();
  if (numeric && number < 0) return true;
  return std::any_of(stated.begin(), stated.end(), [&](const std::string& none) {
    if (none == id) return true;
    double value = 0;
    const auto parsed = std::from_chars(none.data(), none.data() + none.size(), value);
    return numeric && parsed.ec == std::errc() && parsed.ptr == none.data() + none.size() && value == number;
  });
}

}  // namespace smlm
