// Uncertainties have more names than a list could hold; nearly all are made of the same few words.
#include <algorithm>
#include <array>

#include "smlm/column.hpp"

namespace smlm {
namespace {

enum class Meaning { none, spread, variance, width, x, y, z, lateral, filler };

struct Word {
  std::string_view text;
  Meaning meaning;
};

constexpr std::array<Word, 53> words{{
    {"uncertainty", Meaning::spread},
    {"uncertainties", Meaning::spread},
    {"unc", Meaning::spread},
    {"precision", Meaning::spread},
    {"prec", Meaning::spread},
    {"locprec", Meaning::spread},
    {"lp", Meaning::spread},
    {"error", Meaning::spread},
    {"err", Meaning::spread},
    {"accuracy", Meaning::spread},
    {"crlb", Meaning::spread},
    {"crb", Meaning::spread},
    {"std", Meaning::spread},
    {"stdev", Meaning::spread},
    {"stddev", Meaning::spread},
    {"sd", Meaning::spread},
    {"deviation", Meaning::spread},
    {"var", Meaning::variance},
    {"variance", Meaning::variance},
    {"sigma", Meaning::width},
    {"sig", Meaning::width},
    {"\xCF\x83", Meaning::width},
    {"x", Meaning::x},
    {"y", Meaning::y},
    {"z", Meaning::z},
    {"axial", Meaning::z},
    {"xy", Meaning::lateral},
    {"lateral", Meaning::lateral},
    {"loc", Meaning::filler},
    {"locs", Meaning::filler},
    {"localization", Meaning::filler},
    {"localisation", Meaning::filler},
    {"location", Meaning::filler},
    {"fit", Meaning::filler},
    {"position", Meaning::filler},
    {"pos", Meaning::filler},
    {"coordinate", Meaning::filler},
    {"standard", Meaning::filler},
    {"estimated", Meaning::filler},
    {"in", Meaning::filler},
    {"of", Meaning::filler},
    {"the", Meaning::filler},
    {"value", Meaning::filler},
    {"direction", Meaning::filler},
    {"axis", Meaning::filler},
    {"nm", Meaning::filler},
    {"um", Meaning::filler},
    {"px", Meaning::filler},
    {"pix", Meaning::filler},
    {"pixel", Meaning::filler},
    {"pixels", Meaning::filler},
    {"errors", Meaning::spread},
    {"sem", Meaning::spread},
}};
constexpr std::array<std::string_view, 5> unit_words{"nm", "um", "px", "pix", "pixel"};

Meaning meaning_of(std::string_view text) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const Word& w) { return w.text == text; });
  return found == words.end() ? Meaning::none : found->meaning;
}

bool is_spread(Meaning m) { return m == Meaning::spread || m == Meaning::variance || m == Meaning::width; }
bool is_axis(Meaning m) { return m >= Meaning::x && m <= Meaning::lateral; }

// What a word says, also where an axis is glued to it ("xerr", "sigmaxy"): none, one or two meanings.
std::vector<Meaning> meanings(std::string_view word) {
  const Meaning whole = meaning_of(word);
  if (whole != Meaning::none) return {whole};
  for (const std::string_view axis : {"xy", "x", "y", "z"}) {
    if (word.size() <= axis.size()) continue;
    const Meaning before = meaning_of(word.substr(axis.size()));
    if (word.substr(0, axis.size()) == axis && is_spread(before)) return {meaning_of(axis), before};
    const Meaning after = meaning_of(word.substr(0, word.size() - axis.size()));
    if (word.substr(word.size() - axis.size()) == axis && is_spread(after)) return {meaning_of(axis), after};
  }
  return {};
}

// Calls visit(word) for each word of a normalised name; stops where it returns false.
template <class Visit>
bool every_word(std::string_view name, const Visit& visit) {
  while (!name.empty()) {
    const auto end = std::min(name.find('_'), name.size());
    if (end > 0 && !visit(name.substr(0, end))) return false;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return true;
}

}  // namespace

std::optional<ColumnMatch> uncertainty_named(const std::string& normalised_name) {
  Meaning spread = Meaning::none, axis = Meaning::none;
  bool qualified = false;  // says what it is the uncertainty of, so that it is not just any error
  ColumnMatch match;
  const bool understood = every_word(normalised_name, [&](std::string_view word) {
    const std::vector<Meaning> said = meanings(word);
    for (const Meaning m : said) {
      if (is_axis(m)) {
        if (axis != Meaning::none && axis != m) return false;
        axis = m;
      } else if (is_spread(m)) {
        // "sigma uncertainty" would be the uncertainty of a width.
        if (spread != Meaning::none && (spread == Meaning::width || m == Meaning::width)) return false;
        spread = spread == Meaning::variance ? spread : m;
      } else if (std::find(unit_words.begin(), unit_words.end(), word) != unit_words.end()) {
        match.unit = word;
      } else {
        qualified = true;
      }
    }
    qualified = qualified || word == "uncertainty" || word == "precision" || word == "locprec" ||
                word == "prec" || word == "crlb";
    return !said.empty();
  });
  if (!understood || spread == Meaning::none) return std::nullopt;
  match.quantity = axis == Meaning::x   ? Quantity::sigma_x
                   : axis == Meaning::y ? Quantity::sigma_y
                   : axis == Meaning::z ? Quantity::sigma_z
                                        : Quantity::sigma_lateral;
  match.claim = axis == Meaning::none && !qualified ? Claim::weak
                : spread == Meaning::width          ? Claim::likely
                                                    : Claim::plain;
  match.spread = spread == Meaning::variance ? Spread::variance : Spread::standard_deviation;
  return match;
}

bool sounds_like_uncertainty(const std::string& normalised_name) {
  return !every_word(normalised_name, [](std::string_view word) {
    const std::vector<Meaning> said = meanings(word);
    return std::none_of(said.begin(), said.end(),
                        [](Meaning m) { return m == Meaning::spread || m == Meaning::variance; });
  });
}

}  // namespace smlm
