#include "symmetry_stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "polar/core/rng.hpp"
#include "polar/core/symmetry_group.hpp"
#include "symmetry_frame.hpp"
#include "symmetry_judge.hpp"

namespace polar {

namespace {

constexpr int kHighestFold = 24;                                          // of an axis that is looked for
constexpr std::array<int, 9> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23};  // up to it
constexpr double kLikely = 0.5;       // similarity of a frame that is worth judging
constexpr double kTolerance = 0.015;  // held-out log density per localisation that a true group may cost: the
                                      // symmetric template is fitted to poses that an uneven one chose
constexpr double kPlainLoss = 0.03;   // and what makes a warning where a group is imposed
constexpr double kLittleContrast = 2;  // of a template that may be a sphere
constexpr std::uint32_t kFrameStage = 42;

bool is_free(const SymmetryGain& g) { return g.mean > -kTolerance - g.std; }

struct Candidate {
  std::string group;
  std::size_t order;
};

// Every group whose elements of prime order are all among `primes`, largest first: none of the others can be.
std::vector<Candidate> candidates(const std::vector<int>& primes, bool planar) {
  const auto has = [&](int n) { return std::find(primes.begin(), primes.end(), n) != primes.end(); };
  const auto has_factors = [&](int n) {
    return std::all_of(kPrimes.begin(), kPrimes.end(), [&](int p) { return n % p != 0 || has(p); });
  };
  std::vector<Candidate> out;
  if (!planar && has(2) && has(3)) {
    if (has(5)) out.push_back({"I", 60});
    out.push_back({"O", 24}), out.push_back({"T", 12});
  }
  for (int n = kHighestFold; n >= 2; --n) {
    if (!has_factors(n)) continue;
    const auto order = static_cast<std::size_t>(n);
    if (!planar && has(2)) out.push_back({"D" + std::to_string(n), 2 * order});
    if (std::find(kPrimes.begin(), kPrimes.end(), n) == kPrimes.end())
      out.push_back({"C" + std::to_string(n), order});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.order > b.order; });
  return out;
}

class Detection {
 public:
  Detection(const Problem& problem, const NoiseModel& noise, const RoundState& state)
      : problem_(problem), similarity_(state.mixture, problem.planar()), judge_(problem, noise, state) {}

  // Whether the structure has the group as far as the localisations tell; if so it is the answer so far.
  bool has(const std::string& group) {
    const SymmetryFrame f = best_frame(similarity_, group, kLikely);
    return f.similarity >= kLikely && has(group, group, f);
  }

  bool is_sphere() {
    if (problem_.planar() || similarity_.contrast() > kLittleContrast) return false;
    const Eigen::Matrix3d any = KeyedRandom(problem_.seed, 0, kFrameStage).rotation();
    return has("SO3", "I", {"I", {any, -(any * similarity_.centroid())}, 0});
  }

  Symmetry symmetry;

 private:
  bool has(const std::string& name, const std::string& turns, const SymmetryFrame& f) {
    const SymmetryGain g = judge_.gain(symmetry_rotations(turns), f.canonical_from_template);
    symmetry.tried.push_back({name, f.similarity, g.mean, g.std});
    if (!is_free(g)) return false;
    symmetry.group = name;
    symmetry.canonical_from_template = f.canonical_from_template;
    symmetry.gain = g.mean, symmetry.gain_std = g.std;
    return true;
  }

  const Problem& problem_;
  SelfSimilarity similarity_;
  SymmetryJudge judge_;
};

// An axis of the highest order that is looked for, and of an order that shares no factor with it: of any.
void call_continuous(Detection& d) {
  const Symmetry found = d.symmetry;
  const std::string kind = found.group.substr(0, 1);
  if (found.group != kind + std::to_string(kHighestFold)) return;
  const bool any = d.has(kind + std::to_string(kHighestFold - 1));
  const std::vector<SymmetryTrial> tried = d.symmetry.tried;
  d.symmetry = found;
  d.symmetry.tried = tried;
  if (any) d.symmetry.group = kind + "inf";
}

}  // namespace

Symmetry detect_symmetry(const Problem& problem, const NoiseModel& noise, const RoundState& state) {
  Detection d(problem, noise, state);
  if (d.is_sphere()) return d.symmetry;
  std::vector<int> primes;
  for (const int p : kPrimes)
    if (d.has("C" + std::to_string(p))) primes.push_back(p);
  for (const Candidate& c : candidates(primes, problem.planar()))
    if (d.has(c.group)) break;
  call_continuous(d);
  return d.symmetry;
}

Symmetry impose_symmetry(const Problem& problem, const NoiseModel& noise, const std::string& group,
                         RoundState& state) {
  Symmetry out;
  out.imposed = true;
  out.group = group;
  const SymmetryFrame f = best_frame(SelfSimilarity(state.mixture, problem.planar()), group, -INFINITY);
  const RotationGroup turns = symmetry_rotations(group);
  const SymmetryGain g = SymmetryJudge(problem, noise, state).gain(turns, f.canonical_from_template);
  out.gain = g.mean, out.gain_std = g.std;
  out.tried = {{group, f.similarity, g.mean, g.std}};
  state = with_group(std::move(state), noise, turns, f.canonical_from_template);
  return out;
}

std::string symmetry_warning(const Symmetry& s) {
  if (!s.imposed || s.gain > -kPlainLoss - 2 * s.gain_std) return {};
  char loss[32];
  std::snprintf(loss, sizeof loss, "%.3f", -s.gain);
  return "registration.symmetry: the structure does not look like " + s.group + ": imposing it costs " +
         loss +
         " of held-out log likelihood per localisation; registration.symmetry: detect tells which group it "
         "has";
}

}  // namespace polar
