// Uncertainties have more names than a list could hold; nearly all are made of the same few words.
#include <algorithm>
#include <array>
#include <bitset>
#include <vector>

#include "smlm/column.hpp"

namespace smlm {
namespace {

enum class Meaning { none, spread, variance, width, x, y, z, lateral, filler };

struct Word {
  std::string_view text;
  Meaning meaning;
};

constexpr std::array<Word, 57> words{{
    {"uncertainty", Meaning::spread},
    {"uncertainties", Meaning::spread},
    {"unc", Meaning::spread},
    {"uncert", Meaning::spread},
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
    {"dev", Meaning::spread},
    {"rms", Meaning::spread},
    {"rmse", Meaning::spread},
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

constexpr std::size_t longest_word = 40;

// Takes known words off the beginning of `word`, the longest first, until nothing is left; `dead` are the
// lengths of rests that are known not to come apart.
bool come_apart(std::string_view word, std::vector<std::string_view>& parts,
                std::bitset<longest_word + 1>& dead) {
  if (word.empty()) return true;
  if (dead[word.size()]) return false;
  for (std::size_t length = word.size(); length > 0; --length) {
    if (meaning_of(word.substr(0, length)) == Meaning::none) continue;
    parts.push_back(word.substr(0, length));
    if (come_apart(word.substr(length), parts, dead)) return true;
    parts.pop_back();
  }
  dead.set(word.size());
  return false;
}

// A word, or the known words that are glued together in it ("xerr", "znmerr", "localizationprecisionx");
// empty where it is none. Glued words must speak of an uncertainty: many names are made of axes and units.
std::vector<std::string_view> parts_of(std::string_view word) {
  std::vector<std::string_view> parts;
  std::bitset<longest_word + 1> dead;
  if (word.size() > longest_word || !come_apart(word, parts, dead)) return {};
  const bool spread = std::any_of(parts.begin(), parts.end(),
                                  [](std::string_view part) { return is_spread(meaning_of(part)); });
  return parts.size() == 1 || spread ? parts : std::vector<std::string_view>{};
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
  const auto add = [&](std::string_view part) {
    const Meaning m = meaning_of(part);
    if (is_axis(m)) {
      if (axis != Meaning::none && axis != m) return false;
      axis = m;
    } else if (is_spread(m)) {
      // "sigma uncertainty" would be the uncertainty of a width.
      if (spread != Meaning::none && (spread == Meaning::width || m == Meaning::width)) return false;
      spread = spread == Meaning::variance ? spread : m;
    } else if (std::find(unit_words.begin(), unit_words.end(), part) != unit_words.end()) {
      match.unit = part;
    } else {
      qualified = true;
    }
    qualified = qualified || part == "uncertainty" || part == "precision" || part == "locprec" ||
                part == "prec" || part == "crlb";
    return true;
  };
  const bool understood = every_word(normalised_name, [&](std::string_view word) {
    const std::vector<std::string_view> parts = parts_of(word);
    return !parts.empty() && std::all_of(parts.begin(), parts.end(), add);
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
    const std::vector<std::string_view> parts = parts_of(word);
    return std::none_of(parts.begin(), parts.end(), [](std::string_view part) {
      const Meaning m = meaning_of(part);
      return m == Meaning::spread || m == Meaning::variance;
    });
  });
}

}  // namespace smlm
