#include "missing.hpp"

#include <algorithm>
#include <array>

#include "text/number.hpp"

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
      "nan", "nan(ind)", "nan(snan)", "1.#ind", "1.#qnan", "1.#snan", "#ind",    "#qnan",   "na",
      "n/a", "n.a.",     "#n/a",      "<na>",   "none",    "null",    "missing", "#value!", "#num!"};
  return word.empty() || std::find(words.begin(), words.end(), word) != words.end();
}

bool names_no_particle(std::string_view id, const std::vector<std::string>& stated) {
  if (is_missing(id)) return true;
  double number = 0;
  const bool numeric = parse_number(id, number);
  if (numeric && number < 0) return true;
  return std::any_of(stated.begin(), stated.end(), [&](const std::string& none) {
    if (none == id) return true;
    double value = 0;
    return numeric && parse_number(none, value) && value == number;
  });
}

}  // namespace smlm
