#include "label_counts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "emitter.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar::results {

namespace {
constexpr std::uint32_t kStage = 0x86;
constexpr int kSettling = 30, kSweeps = 120;  // before anything is counted, and in all
constexpr int kSwapEvery = 4;                 // sweeps
constexpr std::uint32_t kBackground = ~std::uint32_t{0};
constexpr double kPseudoLabels =
    4;  // that follow a smooth distribution: no number of localisations is impossible
constexpr double kLeast = 1e-4;  // probabilities stay this far from 0 and 1

// What all particles share.
struct Shared {
  double labelled = 0.5;         // probability that a place has a label
  double background_mean = 0;    // localisations a particle
  std::vector<double> size;      // [k]: probability that a label has k localisations; size[0] = 0
  std::vector<double> one_more;  // [n]: (n + 1) P(n + 1) / P(n) of the localisations at a place
};

// One particle: whose every localisation is, and how many each place has.
struct State {
  std::vector<std::uint32_t> of;
  std::vector<std::uint32_t> count;
};

// Sums over the particles after a sweep.
struct Tally {
  std::vector<double> size;      // labels with k localisations
  std::vector<double> shown;     // particles with n labelled places
  std::vector<double> occupied;  // particles that show each place
  double background = 0;
};

// Of labels that have more or fewer localisations than any that was seen, a negative binomial of their mean
// and variance says how probable they are.
std::vector<double> size_distribution(const std::vector<double>& labels) {
  const double total = std::accumulate(labels.begin(), labels.end(), 0.0);
  double mean = 0, square = 0;  // of the localisations beyond the first
  for (std::size_t k = 1; k < labels.size(); ++k) {
    mean += labels[k] * double(k - 1);
    square += labels[k] * double((k - 1) * (k - 1));
  }
  mean = std::max(total > 0 ? mean / total : 0, 0.05);
  const double variance = std::max(total > 0 ? square / total - mean * mean : 0, 1.05 * mean);
  const double p = mean / variance, r = mean * p / (1 - p);
  std::vector<double> size(labels.size(), 0.0);
  for (std::size_t k = 1; k < labels.size(); ++k) {
    const double n = static_cast<double>(k - 1);
    const double smooth = std::exp(std::lgamma(n + r) - std::lgamma(r) - std::lgamma(n + 1) +
                                   r * std::log(p) + n * std::log1p(-p));
    size[k] = (labels[k] + kPseudoLabels * std::max(smooth, 1e-12)) / (total + kPseudoLabels);
  }
  return size;
}

void update_ratios(Shared& s) {
  s.one_more.assign(s.size.size() + 1, 0.0);
  if (s.size.size() < 2) return;
  s.one_more[0] = s.labelled * s.size[1] / (1 - s.labelled);
  for (std::size_t n = 1; n + 1 < s.size.size(); ++n)
    s.one_more[n] = static_cast<double>(n + 1) * s.size[n + 1] / s.size[n];
}

// Draws anew whose every localisation is, one after the other.
void assign(const ParticleCandidates& particle, const Shared& s, double background, State& state,
            KeyedRandom& random, std::vector<double>& weight) {
  const double stray = background * s.background_mean;
  for (std::size_t i = 0; i < particle.size(); ++i) {
    if (state.of[i] != kBackground) --state.count[state.of[i]];
    weight.clear();
    double sum = stray;
    for (const Candidate& c : particle[i]) {
      sum += c.density * s.one_more[state.count[c.place]];
      weight.push_back(sum);
    }
    const double drawn = random.uniform() * sum;
    state.of[i] = kBackground;
    for (std::size_t c = 0; c < weight.size() && drawn >= stray; ++c)
      if (drawn < weight[c]) {
        state.of[i] = particle[i][c].place;
        break;
      }
    if (state.of[i] != kBackground) ++state.count[state.of[i]];
  }
}

double density_at(const std::vector<Candidate>& candidates, std::uint32_t place) {
  for (const Candidate& c : candidates)
    if (c.place == place) return c.density;
  return 0;
}

// Whether the labels of two places change places: one at a time they would have to pass through two half
// labels.
void swap_labels(const ParticleCandidates& particle, std::uint32_t a, std::uint32_t b, State& state,
                 KeyedRandom& random) {
  const double drawn = random.uniform();
  if (a == b || state.count[a] + state.count[b] == 0) return;
  double gain = 0;
  for (std::size_t i = 0; i < particle.size(); ++i) {
    if (state.of[i] != a && state.of[i] != b) continue;
    const std::uint32_t other = state.of[i] == a ? b : a;
    const double there = density_at(particle[i], other);
    if (!(there > 0)) return;
    gain += std::log(there / density_at(particle[i], state.of[i]));
  }
  if (std::log(std::max(drawn, 1e-300)) >= gain) return;
  for (std::uint32_t& of : state.of) of = of == a ? b : of == b ? a : of;
  std::swap(state.count[a], state.count[b]);
}

void add(const State& state, Tally& t) {
  std::size_t shown = 0;
  for (std::size_t u = 0; u < state.count.size(); ++u) {
    if (state.count[u] == 0) continue;
    ++shown;
    t.occupied[u] += 1;
    t.size[state.count[u]] += 1;
  }
  t.shown[shown] += 1;
  for (const std::uint32_t of : state.of) t.background += of == kBackground ? 1 : 0;
}

void blend(std::vector<double>& into, const std::vector<double>& from, double share) {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] += share * (from[i] - into[i]);
}
}  // namespace

std::vector<ParticleCandidates> candidates_of(
    const smlm::LocalisationTable& t, std::size_t places,
    const std::function<double(const Eigen::Matrix3d&, const Eigen::Vector3d&, std::size_t)>& density) {
  const std::vector<std::vector<std::size_t>> rows = rows_of_particles(t);
  std::vector<ParticleCandidates> particles(rows.size());
  parallel_for(rows.size(), [&](std::size_t p) {
    for (const std::size_t row : rows[p]) {
      particles[p].emplace_back();
      const Eigen::Matrix3d c = matrix(t.covariance_nm2[row]);
      const Eigen::Vector3d x(t.position_nm[row].data());
      for (std::size_t k = 0; k < places; ++k)
        if (const double here = density(c, x, k); here > 0)
          particles[p].back().push_back({static_cast<std::uint32_t>(k), here});
    }
  });
  return particles;
}

PlaceCounts count_labels(const std::vector<ParticleCandidates>& particles, std::size_t places,
                         double background, double background_share) {
  PlaceCounts out;
  const std::size_t n = particles.size();
  std::size_t most = 0;
  double localisations = 0;
  for (const ParticleCandidates& p : particles) {
    most = std::max(most, p.size());
    localisations += static_cast<double>(p.size());
  }
  if (n == 0 || places == 0 || most == 0) return out;
  std::vector<State> states(n);
  for (std::size_t p = 0; p < n; ++p) {  // each where it is most probable
    states[p].count.assign(places, 0);
    for (const std::vector<Candidate>& candidates : particles[p]) {
      const auto best =
          std::max_element(candidates.begin(), candidates.end(),
                           [](const Candidate& a, const Candidate& b) { return a.density < b.density; });
      const bool stray = best == candidates.end() || best->density < background;
      states[p].of.push_back(stray ? kBackground : best->place);
      if (!stray) ++states[p].count[best->place];
    }
  }
  const Tally empty{std::vector<double>(most + 1, 0.0), std::vector<double>(places + 1, 0.0),
                    std::vector<double>(places, 0.0), 0};
  const double count = static_cast<double>(n);
  Tally mean = empty;  // over the sweeps, the latest weighing more while it settles
  for (const State& s : states) add(s, mean);
  mean.background = std::max(mean.background, background_share * localisations);
  std::vector<double> shown_sum(n, 0.0), shown_square(n, 0.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Shared shared;
    const double labels = std::accumulate(mean.occupied.begin(), mean.occupied.end(), 0.0);
    shared.labelled = std::clamp(labels / (count * static_cast<double>(places)), kLeast, 1 - kLeast);
    shared.background_mean = std::max(mean.background / count, kLeast);
    shared.size = size_distribution(mean.size);
    update_ratios(shared);
    parallel_for(n, [&](std::size_t p) {
      KeyedRandom random(static_cast<std::uint64_t>(sweep), p, kStage);
      std::vector<double> weight;
      assign(particles[p], shared, background, states[p], random, weight);
      for (std::size_t u = 0; u < places && places > 1 && sweep % kSwapEvery == 0; ++u)
        swap_labels(particles[p], static_cast<std::uint32_t>(u),
                    static_cast<std::uint32_t>(random.below(places)), states[p], random);
    });
    Tally now = empty;
    for (const State& s : states) add(s, now);
    const bool counted = sweep >= kSettling;
    const double share = counted ? 1.0 / (sweep - kSettling + 1) : 0.5;
    blend(mean.size, now.size, share), blend(mean.shown, now.shown, share);
    blend(mean.occupied, now.occupied, share);
    mean.background += share * (now.background - mean.background);
    for (std::size_t p = 0; counted && p < n; ++p) {
      const auto shown = static_cast<double>(std::count_if(states[p].count.begin(), states[p].count.end(),
                                                           [](std::uint32_t c) { return c > 0; }));
      shown_sum[p] += shown, shown_square[p] += shown * shown;
    }
  }
  constexpr double kCounted = kSweeps - kSettling;
  for (std::size_t p = 0; p < n; ++p)
    out.doubt += (shown_square[p] / kCounted - std::pow(shown_sum[p] / kCounted, 2)) / count;
  out.particles = mean.shown;
  out.labels = mean.size;
  for (const double o : mean.occupied) out.occupancy.push_back(o / count);
  out.background_share = mean.background / localisations;
  return out;
}

}  // namespace polar::results
