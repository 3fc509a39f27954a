#include "polar/latent/latent_registration.hpp"

#include "degradation.hpp"
#include "growth.hpp"
#include "medoid.hpp"
#include "multistart.hpp"
#include "polar/core/parallel.hpp"
#include "polar/latent/template.hpp"
#include "report.hpp"

namespace polar {

namespace {

constexpr int kCroppedMedoids = 3;  // a cropped medoid is an incomplete template (paper V.B): several compete
// Steps of a joint descent; AdamW's plateau usually ends it earlier.
constexpr int kFirstSteps = 12, kJointSteps = 60, kAdamSteps = 2000;

class Algorithm1 {
 public:
  Algorithm1(const Views& views, const Autoencoder& model, const LatentOptions& options, Progress& progress)
      : model_(model),
        options_(options),
        progress_(progress),
        views_(latent_views(views, model, options)),
        multistart_(model, options_, views.planar, views.view.size(), progress) {}

  LatentRegistration run() {
    LatentRegistration out;
    out.view.resize(views_.view.size());
    const std::vector<int> first = medoids(views_, first_templates());
    if (first.empty()) {
      out.stopped_because = "no view has localisations";
      return out;
    }
    JointState state = best_start(first);
    out.stopped_because = "the number of loops is limited to " + std::to_string(options_.most_loops);
    while (out.loops < options_.most_loops && !progress_.cancelled()) {
      descend_jointly(model_, views_, options_, joint_steps(), progress_, state);
      if (out.loops == 0) adapt(state);
      const std::vector<int> escaped = multistart_.improve(views_, decoded(state), out.loops + 1, false,
                                                           with_localisations(views_), state);
      out.escaped = static_cast<int>(escaped.size());
      if (progress_.cancelled()) break;
      progress_.step("latent", ++out.loops, options_.most_loops);
      if (escaped.empty()) {  // paper: until sum_i s(.) = 0
        out.converged = true;
        out.stopped_because = "no view escaped from its minimum in the last multistart";
        break;
      }
    }
    if (progress_.cancelled()) out.stopped_because = "cancelled";
    descend_jointly(model_, views_, options_, joint_steps(), progress_, state);
    out.z = state.z;
    out.loss = state.total;
    report(model_, views_, decoded(state), state, multistart_.second(), out);
    return out;
  }

 private:
  int joint_steps() const { return options_.optimizer == "adamw" ? kAdamSteps : kJointSteps; }
  int first_templates() const {
    return options_.medoids > 0 ? options_.medoids : options_.visibility < 1 ? kCroppedMedoids : 1;
  }
  Eigen::Matrix3Xf decoded(const JointState& state) const {
    return template_points(model_, state.z, views_.planar);
  }

  // z = medoid, t = 0, R = FLAMES top 1 (Algorithm 1, its first three lines).
  JointState start_at(int view) const {
    JointState state;
    state.z = views_.view[static_cast<std::size_t>(view)].encoded;
    state.view_from_template.resize(views_.view.size());
    const auto minima = multistart_.minima(views_, decoded(state), state, 0, 1);
    for (std::size_t i = 0; i < minima.size(); ++i)
      if (!minima[i].empty()) state.view_from_template[i] = minima[i].front().view_from_template;
    state.loss.assign(views_.view.size(), 0);
    return state;
  }

  JointState best_start(const std::vector<int>& first) const {
    if (first.size() == 1) return start_at(first.front());
    JointState best;
    best.total = 1e300;
    for (const int view : first) {
      JointState state = start_at(view);
      descend_jointly(model_, views_, options_, kFirstSteps, progress_, state);
      if (state.total < best.total) best = std::move(state);
    }
    return best;
  }

  // What is estimated changes the loss, so the losses of the present poses are taken anew.
  void adapt(JointState& state) {
    if (options_.visibility > 0 && options_.outlier_fraction >= 0) return;
    const Eigen::Matrix3Xf points = decoded(state);
    estimate_degradation(model_, points, state.view_from_template, options_, views_);
    parallel_for(views_.view.size(), [&](std::size_t i) {
      state.loss[i] =
          view_loss(model_, views_.view[i], points, state.view_from_template[i], Derive::nothing).loss;
    });
  }

  const Autoencoder& model_;
  const LatentOptions options_;
  Progress& progress_;
  LatentViews views_;
  Multistart multistart_;
};

}  // namespace

LatentRegistration register_latent(const Views& views, const Autoencoder& model, const LatentOptions& options,
                                   Progress& progress) {
  // AdamW is the paper's descent of z, so its template is always decoded. Among outliers too: the decoder
  // forgets a view's strands, a fused template begins with them (measured, docs/benchmarks.md).
  if (options.template_kind == "fused" && options.optimizer != "adamw" && options.outlier_fraction == 0)
    return grow(views, model, options, progress);
  return Algorithm1(views, model, options, progress).run();
}

}  // namespace polar
