#include "polar/fusion/pair_search.hpp"

#include <algorithm>
#include <cmath>

#include "mixture_kernel_choice.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/fusion/direction_volumes.hpp"
#include "polar/fusion/pose_search.hpp"
#include "polar/fusion/seen_region.hpp"
#include "view_likelihood.hpp"

namespace polar {

namespace {

constexpr std::size_t kMostCentres = 400;  // localisations of a view that serve as the other's template
constexpr std::size_t kCoarse = 16;        // localisations looked at for every rotation and shift
constexpr std::size_t kFine = 128;         // for the promising ones
constexpr std::size_t kJudged = 200;       // when alignments are compared
constexpr int kPromising = 300;            // rotations
constexpr int kEvaluations = 8;            // of each of the two refinements
constexpr float kUnseen = 0.5f;            // share of a view that may lie where the other did not look
constexpr float kSeen = 0.05f;             // share that may be outliers where it did
constexpr float kDensity = 0.07f;          // of both, per unit of volume (planar: of area)
constexpr int kPlanarRotations = 180;

std::vector<std::uint32_t> first_few(const std::vector<std::uint32_t>& order, std::size_t most) {
  return {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()))};
}

Mixture mixture_of(const Eigen::Matrix3Xf& points) {
  Mixture m;
  m.centre = points.leftCols(std::min(points.cols(), static_cast<Eigen::Index>(kMostCentres)));
  m.weight = Eigen::VectorXf::Constant(m.centre.cols(), 1.0f / static_cast<float>(m.centre.cols()));
  m.outlier_fraction = kUnseen;
  m.outlier_density = kDensity;
  sort_into_blocks(m);
  return m;
}

// The median standard deviation of a view's localisations, one number for all directions.
double typical_sigma(const View& view) {
  std::vector<float> variance;
  for (const Symmetric3& c : view.covariance) variance.push_back((c[0] + c[3] + c[5]) / 3);
  return std::sqrt(static_cast<double>(upper_median(std::move(variance))));
}

struct Partial {
  Mixture mixture;
  std::unique_ptr<BlockedMixture> blocked;
  SeenRegion seen;
  SearchView coarse, fine;
  KernelLocalisations searched, judged;
};

struct Evidence {
  double mean = 0;  // over all localisations
  double seen = 0, sum_of_seen = 0;
};

Evidence evidence_of(const Partial& shown, const Partial& judge, const Pose& judge_from_shown) {
  ViewFrame frame(*judge.blocked);
  std::vector<float> density(shown.judged.size());
  mixture_kernel().density(frame.at(judge_from_shown.inverse()), shown.judged.data(),
                           static_cast<int>(shown.judged.size()), density.data());
  Evidence out;
  for (std::size_t j = 0; j < density.size(); ++j) {
    const kernel::Localisation& l = shown.judged[j];
    const Eigen::Vector3d x(l.x, l.y, l.z);
    const bool seen = judge.seen.contains((judge_from_shown * x).cast<float>());
    const double term = std::log((density[j] + (seen ? kSeen : kUnseen) * kDensity) / (kUnseen * kDensity));
    out.mean += term / static_cast<double>(density.size());
    if (seen) out.seen += 1, out.sum_of_seen += term;
  }
  return out;
}

}  // namespace

struct PairSearch::Impl {
  PairSearchOptions options;
  bool planar = false;
  SearchGrid grid;
  SearchOptions search;
  SigmaClasses classes;
  int directions = 1;
  std::vector<Partial> part;

  Match judged(const Partial& first, const Partial& second, const Pose& start) const {
    ViewFrame frame(*first.blocked);
    Pose pose = start.inverse();
    for (const KernelLocalisations* few : {&second.searched, &second.judged})
      pose = refine_pose(frame, *few, pose, first.blocked->background(), planar, kEvaluations)
                 .view_from_template;
    const Evidence of_second = evidence_of(second, first, pose.inverse()),
                   of_first = evidence_of(first, second, pose);
    const double seen = of_second.seen + of_first.seen;
    return {pose.inverse(), of_second.mean + of_first.mean, seen,
            (of_second.sum_of_seen + of_first.sum_of_seen) / std::max(1.0, seen)};
  }
};

PairSearch::PairSearch(const Views& views, const std::vector<Eigen::Vector3f>& axes, const Subsets& subset,
                       const std::vector<int>& which, const PairSearchOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->planar = views.planar;
  impl_->grid = search_grid(views.planar ? kPlanarRotations : options.rotations, views.planar);
  impl_->search.translation = lattice_shifts(options.reach, options.shift, views.planar);
  impl_->search.promising = kPromising;
  impl_->search.step = static_cast<float>(options.shift / 2);
  NoiseModel searching, judging;
  searching.planar = judging.planar = views.planar;
  searching.width = options.search_width;
  impl_->classes = sigma_classes(views, axes, searching, 1);
  impl_->directions = directions_for(impl_->classes, views.planar);
  impl_->part.resize(which.size());
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    const View& view = views.view[i];
    if (subset[i].empty()) return;
    Partial& part = impl_->part[k];
    const Eigen::Matrix3Xf points = view.points(Eigen::all, subset[i]);
    part.mixture = mixture_of(points);
    part.blocked = std::make_unique<BlockedMixture>(part.mixture);
    part.seen = SeenRegion(points);
    const auto searched = [&](std::size_t most) {
      return search_view(view, axes[i], searching, impl_->classes, first_few(subset[i], most));
    };
    part.coarse = searched(kCoarse), part.fine = searched(kFine);
    // The other view's localisations have their own noise, which stands for the template's.
    NoiseModel wide = searching, narrow = judging;
    wide.width = std::hypot(options.search_width, typical_sigma(view));
    narrow.width = std::hypot(options.judging_width, typical_sigma(view));
    part.searched = kernel_localisations(view, axes[i], wide, first_few(subset[i], kFine));
    part.judged = kernel_localisations(view, axes[i], narrow, first_few(subset[i], kJudged));
  });
}

PairSearch::~PairSearch() = default;

std::vector<Match> PairSearch::matches(std::size_t first, const std::vector<std::size_t>& second,
                                       const Eigen::Matrix3f& turn) const {
  std::vector<Match> out(second.size());
  const Partial& a = impl_->part[first];
  if (!a.blocked) return out;
  const DirectionVolumes volumes(
      a.mixture, impl_->classes, impl_->directions, impl_->planar,
      [&](const Eigen::Vector3f& x) { return a.seen.contains(x) ? kSeen / kUnseen : 1.0f; });
  parallel_for(second.size(), [&](std::size_t k) {
    const Partial& b = impl_->part[second[k]];
    if (!b.blocked) return;
    const GridScores scores = score_grid(volumes, b.coarse, impl_->grid, turn, impl_->search, &b.fine);
    for (const Basin& basin : basins(scores, impl_->grid, turn, impl_->options.basins)) {
      const Match match = impl_->judged(a, b, basin.template_from_view);
      if (match.evidence > out[k].evidence) out[k] = match;
    }
  });
  return out;
}

Match PairSearch::refined(std::size_t first, std::size_t second, const Pose& first_from_second) const {
  const Partial &a = impl_->part[first], &b = impl_->part[second];
  if (!a.blocked || !b.blocked) return {first_from_second, 0, 0, 0};
  return impl_->judged(a, b, first_from_second);
}

}  // namespace polar
