#pragma once

#include <string>
#include <vector>

namespace polar::pipeline {

/// The known word with the fewest edits (Levenshtein, V. I. Levenshtein, Soviet Physics Doklady 10, 1966)
/// from `word`; empty when there is none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace polar::pipeline
