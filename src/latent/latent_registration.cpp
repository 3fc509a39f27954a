#include "polar/latent/latent_registration.hpp"

#include <algorithm>
#include <cmath>

#include "degradation.hpp"
#include "descent.hpp"
#include "flames_search.hpp"
#include "medoid.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/latent/template.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kTurnStage = 54;
constexpr int kCroppedMedoids = 3;  // a cropped medoid is an incomplete template (paper V.B): several compete
// Evaluations of one start and steps of a joint descent; AdamW's plateau usually ends it earlier.
constexpr int kEvaluations = 10, kAdamEvaluations = 1000;
constexpr int kFirstSteps = 12, kJointSteps = 60, kAdamSteps = 2000;

class Algorithm1 {
 public:
  Algorithm1(const Views& views, const Autoencoder& model, const LatentOptions& options, Progress& progress)
      : model_(model),
        options_(options),
        progress_(progress),
        views_(latent_views(views, model, options)),
        grid_(latent_grid(options, views.planar)),
        second_(views.view.size()) {}

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
      out.escaped = multistart(state, out.loops + 1);
      progress_.step("latent", ++out.loops, options_.most_loops);
      if (out.escaped == 0) {  // paper: until sum_i s(.) = 0
        out.converged = true;
        out.stopped_because = "no view escaped from its minimum in the last multistart";
        break;
      }
    }
    if (progress_.cancelled()) out.stopped_because = "cancelled";
    descend_jointly(model_, views_, options_, joint_steps(), progress_, state);
    report(state, out);
    return out;
  }

 private:
  bool paper() const { return options_.optimizer == "adamw"; }
  int joint_steps() const { return paper() ? kAdamSteps : kJointSteps; }
  int first_templates() const {
    return options_.medoids > 0 ? options_.medoids : options_.visibility < 1 ? kCroppedMedoids : 1;
  }

  std::vector<std::vector<Minimum>> search(const JointState& state, int round, int most) const {
    KeyedRandom random(options_.seed, static_cast<std::uint64_t>(round), kTurnStage);
    const Eigen::Matrix3f turn = views_.planar ? Eigen::Matrix3f(Eigen::Matrix3f::Identity())
                                               : Eigen::Matrix3f(random.rotation().cast<float>());
    return flames(model_, views_, noise_classes(views_, options_), grid_, turn,
                  template_points(model_, state.z, views_.planar), state.view_from_template, most);
  }

  // z = medoid, t = 0, R = FLAMES top 1 (Algorithm 1, its first three lines).
  JointState start_at(int view) const {
    JointState state;
    state.z = views_.view[static_cast<std::size_t>(view)].encoded;
    state.view_from_template.resize(views_.view.size());
    const auto minima = search(state, 0, 1);
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
    estimate_degradation(model_, state, options_, views_);
    const Eigen::Matrix3Xf points = template_points(model_, state.z, views_.planar);
    parallel_for(views_.view.size(), [&](std::size_t i) {
      state.loss[i] =
          view_loss(model_, views_.view[i], points, state.view_from_template[i], Derive::nothing).loss;
    });
  }

  // FLAMES top M, descent from each, escape test and update; returns the number of escapes.
  int multistart(JointState& state, int round) {
    const auto minima = search(state, round, options_.basins);
    const Eigen::Matrix3Xf points = template_points(model_, state.z, views_.planar);
    std::vector<char> escaped(views_.view.size(), 0);
    parallel_for(views_.view.size(), [&](std::size_t i) {
      std::vector<DescendedPose> found;
      for (const Minimum& m : minima[i])
        found.push_back(descend_pose(model_, views_.view[i], views_.planar, points, m.view_from_template,
                                     options_, paper() ? kAdamEvaluations : kEvaluations));
      escaped[i] = update(i, found, state) ? 1 : 0;
    });
    return static_cast<int>(std::count(escaped.begin(), escaped.end(), 1));
  }

  bool update(std::size_t i, const std::vector<DescendedPose>& found, JointState& state) {
    const auto less = [](const DescendedPose& a, const DescendedPose& b) { return a.loss < b.loss; };
    const auto best = std::min_element(found.begin(), found.end(), less);
    if (best == found.end()) return false;
    const DescendedPose current{state.view_from_template[i], state.loss[i], 0};
    const double limit = options_.escape_deg * kRadiansPerDegree;
    const auto apart = [&](const DescendedPose& a, const DescendedPose& b) {
      return geodesic_angle(a.view_from_template.rotation, b.view_from_template.rotation) >= limit;
    };
    const bool better = best->loss <= current.loss;
    const bool escaped = better && apart(*best, current);  // s, eq. 15
    if (better) {                                          // u, eq. 14
      state.view_from_template[i] = best->view_from_template;
      state.loss[i] = best->loss;
    }
    const DescendedPose kept = better ? *best : current;
    second_[i] = {kept.view_from_template, -1, 0};
    const auto consider = [&](const DescendedPose& p) {
      if (apart(p, kept) && (second_[i].loss < 0 || p.loss < second_[i].loss)) second_[i] = p;
    };
    for (const DescendedPose& p : found) consider(p);
    consider(current);
    return escaped;
  }

  Pose in_views_units(const Pose& view_from_template) const {
    Pose pose = view_from_template.inverse();
    pose.translation /= views_.scale;
    return pose;
  }

  void report(const JointState& state, LatentRegistration& out) const {
    const Eigen::Matrix3Xf points = template_points(model_, state.z, views_.planar);
    out.template_points = points.cast<double>() / views_.scale;
    out.z = state.z;
    out.loss = state.total;
    parallel_for(views_.view.size(), [&](std::size_t i) {
      const LatentView& view = views_.view[i];
      LatentPose& pose = out.view[i];
      pose.n_used = static_cast<int>(view.points.cols());
      if (view.empty()) return;
      pose.template_from_view = in_views_units(state.view_from_template[i]);
      pose.loss = state.loss[i];
      pose.second = in_views_units(second_[i].view_from_template);
      pose.second_loss = second_[i].loss;
      pose.visibility = view.visibility;
      pose.outlier_fraction = view.outlier_fraction;
      pose.covariance = covariance(view_loss(model_, view, points, state.view_from_template[i], Derive::pose),
                                   state.view_from_template[i]);
    });
  }

  Eigen::Matrix<double, 6, 6> covariance(const LossTerm& term, const Pose& view_from_template) const {
    Eigen::Matrix<double, 6, 6> normal = (term.jacobian.transpose() * term.jacobian).cast<double>();
    if (views_.planar)
      for (const int k : {0, 1, 5}) normal.row(k).setZero(), normal.col(k).setZero();
    const double freedom = static_cast<double>(term.residual.size()) - (views_.planar ? 3 : 6);
    const Eigen::Matrix<double, 6, 6> inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
    // R <- exp(w) R, t <- t + v leaves R^T (y - t), the inverse, multiplied from the left by exp(-R^T w) and
    // shifted by -R^T v.
    const Eigen::Matrix3d back = -view_from_template.rotation.transpose();
    Eigen::Matrix<double, 6, 6> change = Eigen::Matrix<double, 6, 6>::Zero();
    change.topLeftCorner<3, 3>() = back;
    change.bottomRightCorner<3, 3>() = back / views_.scale;
    return term.loss / freedom * change * inverse * change.transpose();
  }

  const Autoencoder& model_;
  const LatentOptions options_;
  Progress& progress_;
  LatentViews views_;
  SearchGrid grid_;
  std::vector<DescendedPose> second_;
};

}  // namespace

LatentRegistration register_latent(const Views& views, const Autoencoder& model, const LatentOptions& options,
                                   Progress& progress) {
  return Algorithm1(views, model, options, progress).run();
}

}  // namespace polar
