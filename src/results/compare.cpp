#include "polar/results/compare.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/symmetry_group.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kPairStage = 0x71, kHypothesisStage = 0x72;
constexpr std::size_t kAllPairsUpTo = 2000;     // particles; above, pairs are sampled
constexpr std::size_t kSampledPairs = 2000000;  // the recall's own error is then below 0.1 %
constexpr std::size_t kHypotheses = 200;        // particles tried as the global motion
constexpr std::size_t kPairBlock = 4096;
constexpr int kWeiszfeldSteps = 30;
constexpr double kSmallest_rad = 0.02 * kRadiansPerDegree,
                 kSmallest_nm = 1e-3;  // keep Weiszfeld's weights finite

using Group = std::vector<Eigen::Quaterniond>;

double angle_rad(const Eigen::Quaterniond& q) { return 2 * std::atan2(q.vec().norm(), std::abs(q.w())); }

// The element of the group nearest to q.
const Eigen::Quaterniond& nearest(const Group& group, const Eigen::Quaterniond& q) {
  const Eigen::Quaterniond* best = &group.front();
  for (const Eigen::Quaterniond& g : group)
    if (std::abs(g.dot(q)) > std::abs(best->dot(q))) best = &g;
  return *best;
}

// min over g of the angle between g and q.
double angle_modulo(const Group& group, const Eigen::Quaterniond& q) {
  return angle_rad(nearest(group, q).conjugate() * q);
}

// D_i = estimate_i truth_i^-1: equal to G g_i where the estimate is right.
struct Difference {
  std::size_t row;  // of the truth
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
};

std::map<std::string, const PoseRow*> by_name(const std::vector<PoseRow>& rows, const char* which) {
  std::map<std::string, const PoseRow*> index;
  for (const PoseRow& r : rows)
    if (!index.emplace(r.particle, &r).second)
      throw smlm::Error(smlm::Fault::input, which, "particle '" + r.particle + "' occurs twice");
  return index;
}

// The rows with numbers spelt in one way; nothing where an id is no number or two are the same one.
std::optional<std::vector<PoseRow>> by_number(std::vector<PoseRow> rows) {
  std::set<std::string> seen;
  for (PoseRow& row : rows) {
    double value = 0;
    const char *begin = row.particle.data(), *end = begin + row.particle.size();
    const auto parsed = std::from_chars(begin, end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    row.particle = smlm::number_text(value);
    if (!seen.insert(row.particle).second) return std::nullopt;
  }
  return rows;
}

std::size_t shared_names(const std::vector<PoseRow>& a, const std::vector<PoseRow>& b) {
  std::set<std::string> names;
  for (const PoseRow& row : a) names.insert(row.particle);
  return static_cast<std::size_t>(
      std::count_if(b.begin(), b.end(), [&](const PoseRow& row) { return names.count(row.particle) > 0; }));
}

std::vector<Difference> differences(const std::vector<PoseRow>& estimate, const std::vector<PoseRow>& truth,
                                    Comparison& out) {
  constexpr std::size_t fewest = 2;
  if (shared_names(estimate, truth) < fewest) {
    const auto estimate_by_number = by_number(estimate), truth_by_number = by_number(truth);
    if (estimate_by_number && truth_by_number &&
        shared_names(*estimate_by_number, *truth_by_number) >= fewest) {
      out.note = "ids are matched as numbers: '" + truth.front().particle +
                 "' of the truth is spelt otherwise in the "
                 "estimate";
      return differences(*estimate_by_number, *truth_by_number, out);
    }
  }
  const auto found = by_name(estimate, "estimated poses");
  by_name(truth, "true poses");
  std::vector<Difference> difference;
  for (const PoseRow& t : truth) {
    if (!t.template_from_view) continue;
    ++out.n_truth;
    out.particle.push_back({t.particle});
    const auto match = found.find(t.particle);
    if (match == found.end() || !match->second->template_from_view) continue;
    const Pose d = *match->second->template_from_view * t.template_from_view->inverse();
    difference.push_back({out.particle.size() - 1, Eigen::Quaterniond(d.rotation), d.translation});
    out.particle.back().compared = true;
  }
  out.n_compared = difference.size();
  return difference;
}

std::vector<double> pair_angles_deg(const std::vector<Difference>& d, const Group& group,
                                    std::uint64_t seed) {
  const std::size_t n = d.size();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pair;
  if (n <= kAllPairsUpTo) {
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = i + 1; j < n; ++j) pair.emplace_back(i, j);
  } else {
    KeyedRandom random(seed, 0, kPairStage);
    for (std::size_t p = 0; p < kSampledPairs; ++p) {
      const std::uint64_t i = random.below(n), j = (i + 1 + random.below(n - 1)) % n;
      pair.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
  }
  std::vector<double> angle(pair.size());
  parallel_blocks(pair.size(), kPairBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p)
      angle[p] = angle_modulo(group, d[pair[p].first].rotation.conjugate() * d[pair[p].second].rotation) /
                 kRadiansPerDegree;
  });
  return angle;
}

// The rotation that most particles agree on: every hypothesis is one particle's own; errors count up to a
// cap, so that wrong particles cannot pull.
Eigen::Quaterniond best_hypothesis(const std::vector<Difference>& d, const Group& group, std::uint64_t seed) {
  const std::size_t tries = std::min(kHypotheses, d.size());
  std::vector<double> cost(tries, 0);
  std::vector<std::size_t> chosen(tries);
  KeyedRandom random(seed, 0, kHypothesisStage);
  for (std::size_t h = 0; h < tries; ++h) chosen[h] = d.size() <= kHypotheses ? h : random.below(d.size());
  parallel_for(tries, [&](std::size_t h) {
    for (const Difference& other : d)
      cost[h] += std::min(kAlignedWithin_deg * kRadiansPerDegree,
                          angle_modulo(group, d[chosen[h]].rotation.conjugate() * other.rotation));
  });
  const auto best = std::min_element(cost.begin(), cost.end()) - cost.begin();
  return d[chosen[static_cast<std::size_t>(best)]].rotation;
}

// Geodesic median of the aligned rotations (Weiszfeld on the tangent space).
Eigen::Quaterniond refined(Eigen::Quaterniond global, const std::vector<Difference>& d, const Group& group) {
  for (int step = 0; step < kWeiszfeldSteps; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const Difference& other : d) {
      const Eigen::Quaterniond relative = global.conjugate() * other.rotation;
      const Eigen::Quaterniond rest = relative * nearest(group, relative).conjugate();
      const double a = angle_rad(rest);
      if (a > kAlignedWithin_deg * kRadiansPerDegree) continue;
      const double weight = 1 / std::max(a, kSmallest_rad);
      const Eigen::Vector3d axis = rest.vec() * (rest.w() < 0 ? -1 : 1);
      if (axis.norm() > 0) sum += weight * a * axis.normalized();
      weights += weight;
    }
    const Eigen::Vector3d w = sum / std::max(weights, 1e-300);
    if (w.norm() > 0) global = global * Eigen::Quaterniond(Eigen::AngleAxisd(w.norm(), w.normalized()));
  }
  return global.normalized();
}

Eigen::Vector3d geometric_median(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  if (points.empty()) return centre;
  for (const Eigen::Vector3d& p : points) centre += p / static_cast<double>(points.size());
  for (int step = 0; step < kWeiszfeldSteps; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const Eigen::Vector3d& p : points) {
      const double weight = 1 / std::max((p - centre).norm(), kSmallest_nm);
      sum += weight * p;
      weights += weight;
    }
    centre = sum / weights;
  }
  return centre;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const std::size_t half = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end());
  if (values.size() % 2 == 1) return values[half];
  const double below = *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half));
  return (below + values[half]) / 2;
}

double share_within(const std::vector<double>& sorted, double limit) {
  return static_cast<double>(std::upper_bound(sorted.begin(), sorted.end(), limit) - sorted.begin()) /
         static_cast<double>(sorted.size());
}

void compare_particles(const std::vector<Difference>& d, const Group& group, std::uint64_t seed,
                       Comparison& out) {
  const Eigen::Quaterniond global = refined(best_hypothesis(d, group, seed), d, group);
  std::vector<double> rotation_deg, translation_nm;
  std::vector<Eigen::Vector3d> centre_nm;
  for (const Difference& x : d) {
    rotation_deg.push_back(angle_modulo(group, global.conjugate() * x.rotation) / kRadiansPerDegree);
    if (rotation_deg.back() <= kAlignedWithin_deg) centre_nm.push_back(x.translation);
  }
  out.global_motion = {global.toRotationMatrix(), geometric_median(centre_nm)};
  out.n_aligned = centre_nm.size();
  for (std::size_t i = 0; i < d.size(); ++i) {
    ParticleError& error = out.particle[d[i].row];
    error.rotation_deg = rotation_deg[i];
    error.translation_nm = (d[i].translation - out.global_motion.translation).norm();
    if (error.rotation_deg <= kAlignedWithin_deg) translation_nm.push_back(error.translation_nm);
  }
  out.median_rotation_deg = median(rotation_deg);
  out.median_translation_nm = median(translation_nm);
}
}  // namespace

Comparison compare_poses(const std::vector<PoseRow>& estimate, const std::vector<PoseRow>& truth,
                         const CompareOptions& options) {
  Comparison out;
  Group group;
  for (const Eigen::Matrix3d& g : symmetry_rotations(options.symmetry)) group.emplace_back(g);
  const std::vector<Difference> d = differences(estimate, truth, out);
  if (d.size() < 2)
    throw smlm::Error(smlm::Fault::input, "evaluation",
                      std::to_string(d.size()) + " of " + std::to_string(out.n_truth) +
                          " true particles have an estimated pose" +
                          (estimate.empty() || truth.empty()
                               ? ""
                               : " (ids are '" + truth.front().particle + "', ... in the truth and '" +
                                     estimate.front().particle + "', ... in the estimate)"),
                      "at least two are needed; are both tables of the same particles?");
  std::vector<double> angle = pair_angles_deg(d, group, options.seed);
  std::sort(angle.begin(), angle.end());
  out.n_pairs = angle.size();
  out.sampled = d.size() > kAllPairsUpTo;
  out.median_pair_deg = median(angle);
  out.angles_deg = options.angles_deg;
  const auto compared = static_cast<double>(d.size()), all = static_cast<double>(out.n_truth);
  const double covered = compared * (compared - 1) / (all * (all - 1));
  for (const double limit : options.angles_deg) {
    out.recall.push_back(share_within(angle, limit));
    out.recall_of_truth.push_back(out.recall.back() * covered);
  }
  for (int degree = 1; degree <= 180; ++degree) out.cdf.push_back(share_within(angle, degree));
  compare_particles(d, group, options.seed, out);
  return out;
}

}  // namespace polar
