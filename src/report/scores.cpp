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
  double cut = PoseRow::kNone;  // what the run demanded
  bool at_least = false;        // the cut is the least that is accepted, else the most
  std::vector<double> values{}, refused{};

  std::size_t cut_off() const {
    return static_cast<std::size_t>(std::count_if(refused.begin(), refused.end(),
                                                  [&](double v) { return at_least ? v < cut : v > cut; }));
  }
};

// A margin needs two poses: where the search found one only, the record holds 0 and all of the posterior is
// there.
double margin_of(const ParticleScores& p) {
  return p.margin == 0 && p.fit.posterior_share == 1 ? PoseRow::kNone : p.margin;
}

std::vector<Score> scores_of(const RunRecord& r) {
  std::vector<Score> s = {
      {"log-likelihood", "Log likelihood", "log likelihood [nat a localisation]", ""},
      {"margin", "Margin", "above the second-best pose [nat a localisation]",
       "Near zero: another pose explains the particle as well."},
      {"posterior-share", "Share of the posterior at this pose", "share",
       "The margin, weighed with the localisations that tell.", r.least_posterior_share, true},
      {"rotation-std", "Uncertainty of the rotation", "standard deviation [deg]", "",
       r.most_rotation_std_deg},
      {"translation-std", "Uncertainty of the place", "standard deviation [nm]", ""},
      {"visibility", "Visibility", "share of the template that a particle shows", ""},
      {"outliers", "Outliers", "share of localisations that the template does not explain", "",
       r.most_outliers}};
  const auto add = [&](const ParticleScores& p, bool accepted) {
    const double of[] = {p.log_likelihood,     margin_of(p),     p.fit.posterior_share, p.rotation_std_deg,
                         p.translation_std_nm, p.fit.visibility, p.fit.outlier_fraction};
    for (std::size_t k = 0; k < s.size(); ++k) (accepted ? s[k].values : s[k].refused).push_back(of[k]);
  };
  for (std::size_t i = 0; i < r.poses.size(); ++i) {
    const PoseRow& p = r.poses[i];
    if (p.accepted)
      add({p.log_likelihood, p.margin, p.rotation_std_deg, p.translation_std_nm, r.fit[i]}, true);
  }
  for (const ParticleScores& p : r.refused) add(p, false);
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

// A cut-off far beyond all values would flatten them: it is said, not drawn.
bool can_be_drawn(double cut, const Histogram& h) {
  const double span = h.high() - h.low;
  return std::isfinite(cut) && cut > h.low - span && cut < h.high() + span;
}

// What the run demanded; empty where it demands nothing of this score.
std::string limit_text(const Score& score) {
  if (!std::isfinite(score.cut)) return {};
  return std::string(score.at_least ? " At least " : " At most ") + digits(score.cut) + " is accepted";
}

Figure score_figure(const Score& score, std::size_t unlike) {
  std::vector<double> all = score.values;
  all.insert(all.end(), score.refused.begin(), score.refused.end());
  const std::vector<double> finite = sorted_finite(all), accepted = sorted_finite(score.values);
  if (finite.empty())
    return absent(score.id, score.title,
                  all.empty()                         ? "No particle has a pose."
                  : std::string(score.id) == "margin" ? "No second pose was found for any particle."
                                                      : "The record does not hold it.");
  if (finite.front() == finite.back())
    return absent(score.id, score.title,
                  "All particles have " + digits(finite[0]) + "." + limit_text(score) +
                      (std::isfinite(score.cut) ? "." : ""));
  const Histogram h = histogram(all);
  const Histogram of_accepted = histogram_between(score.values, h.low, h.high(), h.count.size());
  std::string caption =
      accepted.empty() ? "No particle was accepted. " : "Median " + digits(upper_median(accepted)) + ". ";
  caption += std::string(score.caption) + (*score.caption ? " " : "");
  std::vector<std::pair<double, std::string>> cuts;
  if (std::string(score.id) == "margin" && finite.size() < all.size())
    caption += "Without those for which no second pose was found: " +
               counted(all.size() - finite.size(), "particle") + ". ";
  if (std::string(score.id) == "log-likelihood") {
    cuts = stranger_cuts(accepted);
    caption += cuts.empty() ? "Too few particles to tell one that is unlike the others."
                            : "Dashed: six robust standard deviations from the median. Beyond: " +
                                  counted(unlike, "particle") + ", accepted but unlike the others.";
  }
  if (std::isfinite(score.cut)) {
    const bool drawn = can_be_drawn(score.cut, h);
    if (drawn) cuts.emplace_back(score.cut, digits(score.cut));
    caption += limit_text(score) + (drawn ? " (dashed)" : "") + ": " + counted(score.cut_off(), "particle") +
               " beyond.";
  }
  return {score.id, score.title,
          histogram_svg(h, score.label, "particles", score.refused.empty() ? "c1" : "c2", cuts,
                        score.refused.empty() ? nullptr : &of_accepted),
          caption + beyond(h)};
}
}  // namespace

Section scores_section(const Subject& subject) {
  const RunRecord& record = subject.record;
  Section s{"scores", "Scores", {}, {}, {}};
  const std::size_t unlike = strangers(record.poses).size();
  for (const Score& score : scores_of(record)) s.figures.push_back(score_figure(score, unlike));
  s.figures.push_back(rejections_figure(record));
  return s;
}

}  // namespace polar::report
