#include "nearest.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace polar::pipeline {

namespace {
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}
}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t kLongestWord = 256;  // a key of a megabyte is not worth comparing
  const std::string start = word.substr(0, kLongestWord);
  std::string best;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const std::string& k : known) {
    const std::size_t n = edits(start, k);
    if (n < fewest) {
      fewest = n;
      best = k;
    }
  }
  return best;
}

}  // namespace polar::pipeline
