#include "verdict.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "polar/core/median.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr double kFewestFit = 0.5;  // share of particles

double median_of(const RunRecord& record, double PoseRow::*number) {
  std::vector<double> values;
  for (const PoseRow& p : record.poses)
    if (p.accepted && std::isfinite(p.*number)) values.push_back(p.*number);
  return values.empty() ? PoseRow::kNone : upper_median(values);
}

// The first reason to doubt; empty where there is none.
std::string doubt(const RunRecord& record) {
  const std::size_t accepted = accepted_particles(record), all = record.poses.size();
  if (record.resolution && !record.resolution->supported())
    return "two halves of the particles, registered independently, have no more in common than pure noise";
  if (static_cast<double>(accepted) < kFewestFit * static_cast<double>(all))
    return "only " + std::to_string(accepted) + " of " + counted(all, "particle") +
           " fit the average; most of the "
           "others: " +
           most_frequent_reason(record);
  if (!record.converged) return "the registration did not come to rest (" + record.stopped_because + ")";
  return {};
}

std::string support(const RunRecord& record) {
  std::vector<std::string> reasons;
  if (record.resolution)
    reasons.push_back("independent halves agree down to " + resolution_text(record.resolution->data) +
                      ", which noise does not");
  if (record.agreement > 0)
    reasons.push_back("two searches from unrelated beginnings pose " + percent(record.agreement) +
                      " of the particles alike");
  if (reasons.empty()) reasons.emplace_back("it explains localisations that were kept apart from it");
  std::string text;
  for (const std::string& r : reasons) text += (text.empty() ? "" : ", and ") + r;
  return text;
}
}  // namespace

std::string resolution_text(const HalfMaps& h) {
  if (!std::isfinite(h.resolution.period_nm)) return "nothing";
  return digits(h.resolution.period_nm) + " nm" + (h.resolution.at_nyquist ? " or better" : "");
}

std::string most_frequent_reason(const RunRecord& record) {
  std::map<std::string, std::size_t> count;
  for (const PoseRow& p : record.poses)
    if (!p.accepted) ++count[p.reason];
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? std::string() : most->first + " (" + std::to_string(most->second) + ")";
}

namespace {
// Begins with a capital letter and ends with a full stop.
std::string as_sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  for (std::size_t at; (at = text.find(" +- ")) != std::string::npos;) text.replace(at, 4, " ± ");
  return text.back() == '.' ? text : text + ".";
}
}  // namespace

Verdict verdict(const RunRecord& record) {
  Verdict v;
  const std::size_t accepted = accepted_particles(record), all = record.poses.size();
  v.state = record.verdict, v.sentence = record.verdict_sentence;
  if (v.state != "found" && v.state != "ambiguous" && v.state != "none") {
    const std::string why_not = doubt(record);
    v.state = accepted == 0 ? "none" : why_not.empty() ? "found" : "ambiguous";
    v.sentence = v.state == "none"
                     ? "none of " + counted(all, "particle") +
                           " has a pose; most were rejected because: " + most_frequent_reason(record)
                 : v.state == "ambiguous" ? why_not
                                          : std::to_string(accepted) + " of " + counted(all, "particle") +
                                                " fit one structure: " + support(record);
  }
  v.sentence = as_sentence(v.sentence);
  v.warnings = record.warnings;
  if (accepted > 0 && !record.resolution && record.agreement == 0)
    v.warnings.emplace_back(
        "nothing independent stands beside this average: no half-maps were made (output.resolution: halves), "
        "and no "
        "two searches were found to agree; compare another seed before trusting details");
  for (std::size_t i = 0; i < record.rejected_rows.size(); ++i)
    v.warnings.push_back(std::to_string(record.rejected_rows[i]) +
                         " rows were left out while reading: " + record.rejected_rows_reason[i]);
  return v;
}

std::vector<KeyNumber> key_numbers(const RunRecord& record) {
  const std::size_t accepted = accepted_particles(record), all = record.poses.size();
  std::vector<KeyNumber> numbers;
  numbers.push_back({"particles accepted", std::to_string(accepted) + " of " + std::to_string(all),
                     all ? percent(static_cast<double>(accepted) / static_cast<double>(all),
                                   accepted == all || accepted == 0 ? 0 : 1)
                         : ""});
  const std::size_t aligned = record.result.superparticle.size();
  std::size_t left = 0;
  for (const PoseRow& p : record.poses) left += p.accepted ? 0 : p.n_localisations;
  numbers.push_back(
      {"localisations aligned", std::to_string(aligned),
       accepted ? digits(static_cast<double>(aligned) / static_cast<double>(accepted)) + " a particle"
                : std::to_string(left) + " in rejected particles"});
  if (record.resolution)
    numbers.push_back({"resolution", resolution_text(record.resolution->data),
                       "noise alone: " + resolution_text(record.resolution->noise)});
  else
    numbers.push_back({"resolution", "not asked for", "output.resolution: halves"});
  numbers.push_back({"precision of a pose",
                     accepted ? digits(median_of(record, &PoseRow::translation_std_nm)) + " nm" : "none",
                     accepted ? digits(median_of(record, &PoseRow::rotation_std_deg)) + "°, medians" : ""});
  if (record.symmetry)
    numbers.push_back({"symmetry", record.symmetry->group == "C1" ? "none found" : record.symmetry->group,
                       record.symmetry->group == "C1" ? ""
                       : record.symmetry->asked       ? "as asked for"
                       : record.symmetry->imposed     ? "by evidence"
                                                      : "reported, not used"});
  else
    numbers.push_back({"symmetry", "not asked for", "registration.symmetry: detect"});
  if (record.labelling)
    numbers.push_back({"labelling", percent(record.labelling->efficiency, 1),
                       percent(record.labelling->low, 1) + " to " + percent(record.labelling->high, 1)});
  return numbers;
}

}  // namespace polar::report
