#include "growth.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "degradation.hpp"
#include "fused_template.hpp"
#include "medoid.hpp"
#include "multistart.hpp"
#include "polar/core/parallel.hpp"
#include "report.hpp"

namespace polar {

namespace {

constexpr int kSearched = 256;        // localisations of a view while basins are sought
constexpr double kTrusted = 2.0 / 3;  // of the views, those of lowest loss, make the template until the end
constexpr int kTightenings = 3, kEvaluations = 4;  // fusing and descending by turns after a search
constexpr double kUnknown = 1e300;

class Growth {
 public:
  Growth(const Views& views, const Autoencoder& model, const LatentOptions& options, Progress& progress)
      : input_(views),
        model_(model),
        options_(options),
        progress_(progress),
        views_(latent_views(views, model, searching(options))),
        multistart_(model, options, views.planar, views.view.size(), progress) {}

  LatentRegistration run() {
    LatentRegistration out;
    out.view.resize(views_.view.size());
    const std::vector<int> first = medoids(views_, std::max(1, options_.medoids));
    if (first.empty()) {
      out.stopped_because = "no view has localisations";
      return out;
    }
    begin(first);
    out.loops = 1;
    progress_.step("latent", out.loops, options_.most_loops);
    out.stopped_because = "the number of loops is limited to " + std::to_string(options_.most_loops);
    std::vector<int> searched = with_localisations(views_);
    while (out.loops < options_.most_loops && !progress_.cancelled()) {
      const std::vector<int> escaped =
          multistart_.improve(views_, points_, out.loops, true, searched, forgotten(searched));
      if (progress_.cancelled()) break;
      out.escaped = static_cast<int>(escaped.size());
      tighten(kTrusted);
      progress_.step("latent", ++out.loops, options_.most_loops);
      if (escaped.empty()) {  // paper: until sum_i s(.) = 0
        out.converged = true;
        out.stopped_because = "no view escaped from its minimum in the last multistart";
        break;
      }
      searched = unsettled(escaped);
    }
    if (progress_.cancelled()) out.stopped_because = "cancelled";
    finish();
    out.z = model_.encode(points_).latent;
    out.loss = std::accumulate(state_.loss.begin(), state_.loss.end(), 0.0);
    report(model_, views_, points_, state_, multistart_.second(), out);
    return out;
  }

 private:
  static LatentOptions searching(LatentOptions options) {
    options.localisations = std::min(options.localisations, kSearched);
    return options;
  }

  // A new template: the losses under the old one are no measure.
  PosedViews& forgotten(const std::vector<int>& which) {
    for (const int i : which) state_.loss[static_cast<std::size_t>(i)] = kUnknown;
    return state_;
  }

  // What is searched again: views that escaped or do not make the template.
  std::vector<int> unsettled(const std::vector<int>& escaped) const {
    const std::vector<int> trusted = best_views(views_, state_.loss, kTrusted);
    std::vector<int> out;
    for (const int i : with_localisations(views_))
      if (!std::binary_search(trusted.begin(), trusted.end(), i) ||
          std::binary_search(escaped.begin(), escaped.end(), i))
        out.push_back(i);
    return out;
  }

  double trusted_loss() const {
    double sum = 0;
    for (const int i : best_views(views_, state_.loss, kTrusted))
      sum += state_.loss[static_cast<std::size_t>(i)];
    return sum;
  }

  void fuse(const std::vector<int>& which) {
    points_ = fused_template(views_, which, state_.view_from_template, model_.decoded_points(), options_.seed,
                             draw_++);
  }

  void begin(const std::vector<int>& first) {
    PosedViews best;
    Eigen::Matrix3Xf best_points;
    double lowest = 2 * kUnknown;
    for (const int view : first) {
      state_.view_from_template.assign(views_.view.size(), Pose());
      state_.loss.assign(views_.view.size(), kUnknown);
      fuse({view});
      multistart_.improve(views_, points_, 0, false, with_localisations(views_), state_);
      estimate_degradation(model_, points_, state_.view_from_template, options_, views_);
      tighten(kTrusted);
      const double loss = trusted_loss();
      if (loss < lowest) lowest = loss, best = state_, best_points = points_;
    }
    state_ = std::move(best);
    points_ = std::move(best_points);
  }

  void tighten(double share) {
    for (int k = 0; k < kTightenings && !progress_.cancelled(); ++k) {
      fuse(best_views(views_, state_.loss, share));
      parallel_for(views_.view.size(), [&](std::size_t i) {
        const DescendedPose p = descend_pose(model_, views_.view[i], views_.planar, points_,
                                             state_.view_from_template[i], options_, kEvaluations);
        state_.view_from_template[i] = p.view_from_template;
        state_.loss[i] = p.loss;
      });
    }
    fuse(best_views(views_, state_.loss, share));
  }

  // All localisations that may take part, and all views in the template.
  void finish() {
    LatentViews fine = latent_views(input_, model_, options_);
    for (std::size_t i = 0; i < fine.view.size(); ++i)
      set_degradation(fine.view[i], i, model_.decoded_points(), views_.view[i].visibility,
                      views_.view[i].outlier_fraction, options_);
    views_ = std::move(fine);
    tighten(1);
  }

  const Views& input_;
  const Autoencoder& model_;
  const LatentOptions options_;
  Progress& progress_;
  LatentViews views_;
  Multistart multistart_;
  PosedViews state_;
  Eigen::Matrix3Xf points_;
  int draw_ = 0;
};

}  // namespace

LatentRegistration grow(const Views& views, const Autoencoder& model, const LatentOptions& options,
                        Progress& progress) {
  return Growth(views, model, options, progress).run();
}

}  // namespace polar
