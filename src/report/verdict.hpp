// What was found, in a sentence, and the numbers that stand beside it.
#pragma once

#include <string>
#include <vector>

#include "polar/report/record.hpp"

namespace polar::report {

struct Verdict {
  std::string state;                  // found | ambiguous | none
  std::string sentence;               // why
  std::vector<std::string> warnings;  // the run's own, and what a reader must know before trusting it
};

/// The record's own verdict where it has one. Else none without an accepted particle; ambiguous where the
/// halves have no more in common than noise, fewer than half of the particles fit, or the rounds did not end
/// by themselves; else found.
Verdict verdict(const RunRecord& record);

/// A number, its unit, and a line below it.
struct KeyNumber {
  std::string name, value, note;
};
std::vector<KeyNumber> key_numbers(const RunRecord& record);

/// "4.2 nm", "4.2 nm or better", or "nothing".
std::string resolution_text(const HalfMaps& halves);

/// The most frequent reason of a rejection with its count; empty where nothing was rejected.
std::string most_frequent_reason(const RunRecord& record);

}  // namespace polar::report
