// How well particles fit: distributions of every score, what cuts them off, and what was rejected why.
#include <algorithm>
#include <cmath>
#include <map>

#include "bars.hpp"
#include "plot.hpp"
#include "polar/core/median.hpp"
#include "polar/results/strangers.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
struct Score {
  const char *id, *title, *label, *caption;
  std::vector<double> values;
};

std::vector<Score> scores_of(const RunRecord& record) {
  std::vector<Score> s;
  const auto add = [&](const char* id, const char* title, const char* label, const char* caption,
                       const auto& value) {
    s.push_back({id, title, label, caption, {}});
    for (std::size_t i = 0; i < record.poses.size(); ++i)
      if (record.poses[i].accepted) s.back().values.push_back(value(record.poses[i], record.fit[i]));
  };
  using P = const PoseRow&;
  using F = const ParticleFit&;
  add("log-likelihood", "Log likelihood", "log likelihood [nat a localisation]", "",
      [](P p, F) { return p.log_likelihood; });
  add("margin", "Margin", "above the second-best pose [nat a localisation]",
      "Near zero: another pose explains the particle as well, as every turn of a symmetry does.",
      [](P p, F) { return p.margin; });
  add("rotation-std", "Uncertainty of the rotation", "standard deviation [deg]", "",
      [](P p, F) { return p.rotation_std_deg; });
  add("translation-std", "Uncertainty of the place", "standard deviation [nm]", "",
      [](P p, F) { return p.translation_std_nm; });
  add("rotation-spread", "Spread of the rotation over all poses", "standard deviation [deg]",
      "Far above the uncertainty: other poses are as likely.",
      [](P, F f) { return f.posterior_rotation_deg; });
  add("translation-spread", "Spread of the place over all poses", "standard deviation [nm]", "",
      [](P, F f) { return f.posterior_translation_nm; });
  add("visibility", "Visibility", "share of the template that a particle shows", "",
      [](P, F f) { return f.visibility; });
  add("outliers", "Outliers", "share of localisations that the template does not explain", "",
      [](P, F f) { return f.outlier_fraction; });
  return s;
}

// Beyond the axis's end: counted in its last bin, and said.
std::string beyond(const Histogram& h) {
  std::string text;
  if (h.below > 0) text += " " + std::to_string(h.below) + " lie below the axis";
  if (h.above > 0) text += std::string(text.empty() ? " " : " and ") + std::to_string(h.above) + " above it";
  return text.empty() ? text : text + ": in the outermost bars.";
}

// Where `strangers` draws its line.
std::vector<std::pair<double, std::string>> stranger_cuts(const std::vector<double>& values) {
  const StrangerLimits limits = stranger_limits(values);
  if (!std::isfinite(limits.low)) return {};
  return {{limits.low, "unlike"}, {limits.high, "unlike"}};
}

Figure rejections_figure(const RunRecord& record) {
  std::map<std::string, std::size_t> count;
  for (const PoseRow& p : record.poses)
    if (!p.accepted) ++count[p.reason.empty() ? "no reason given" : p.reason];
  if (count.empty()) return absent("rejections", "Rejected", "No particle was rejected.");
  std::vector<Bar> bars;
  for (const auto& [reason, n] : count)
    bars.push_back({reason.size() > 48 ? reason.substr(0, 46) + "..." : reason, static_cast<double>(n),
                    std::to_string(n)});
  std::stable_sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) { return a.value > b.value; });
  std::string words;
  for (const auto& [reason, n] : count)
    words += (words.empty() ? "" : "; ") + std::to_string(n) + ": " + reason;
  return {"rejections", "Rejected", bars_svg(bars, "rejected particles by reason"), words + "."};
}
}  // namespace

Section scores_section(const Subject& subject) {
  const RunRecord& record = subject.record;
  Section s{"scores", "Scores", {}, {}, {}};
  for (const Score& score : scores_of(record)) {
    const std::vector<double> finite = sorted_finite(score.values);
    if (finite.empty()) {
      s.figures.push_back(
          absent(score.id, score.title,
                 score.values.empty() ? "No particle has a pose." : "The record does not hold it."));
      continue;
    }
    if (finite.front() == finite.back()) {
      s.figures.push_back(
          absent(score.id, score.title, "All accepted particles have " + digits(finite[0]) + "."));
      continue;
    }
    const Histogram h = histogram(score.values);
    const bool likelihood = std::string(score.id) == "log-likelihood";
    std::string caption = std::string(score.caption) + beyond(h);
    const auto cuts = likelihood ? stranger_cuts(finite) : std::vector<std::pair<double, std::string>>{};
    if (likelihood) {
      const std::size_t unlike = strangers(record.poses).size();
      caption = cuts.empty()
                    ? "Too few particles to tell one that is unlike the others." + caption
                    : "Dashed: six robust standard deviations from the median. Beyond: " +
                          counted(unlike, "particle") + ", accepted but unlike the others." + caption;
    }
    s.figures.push_back({score.id, score.title, histogram_svg(h, score.label, "particles", "c1", cuts),
                         "Median " + digits(upper_median(finite)) + ". " + caption});
  }
  s.figures.push_back(rejections_figure(record));
  return s;
}

}  // namespace polar::report
