#include "polar/fusion/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/median.hpp"
#include "polar/core/nelder_mead.hpp"

namespace polar {

namespace {

constexpr double kPriorWidth =
    0.1;  // of ln a; decides only where sigma hardly varies, a few localisations outweigh it
constexpr double kSmallestExtra = 1e-3;  // of b, particle radii
constexpr double kLargestExtra = 0.5;
constexpr double kFirstStep = -0.4;  // of ln a and ln b
constexpr int kMostEvaluations = 90;
constexpr double kTolerance = 1e-4;  // mean log density: far below any decision
constexpr std::size_t kMostLocalisations = 20000;
constexpr float kAxisRatio = 1.1f;  // axial over lateral

using Parameters = std::vector<double>;  // ln a, ln b lateral [, axial]

NoiseModel model(const Parameters& p, const NoiseModel& like) {
  NoiseModel noise = like;
  const auto extra = [](double v) { return std::clamp(std::exp(v), kSmallestExtra, kLargestExtra); };
  noise.width = 0;
  noise.lateral_factor = std::exp(p[0]), noise.lateral_extra = extra(p[1]);
  noise.axial_factor = p.size() > 2 ? std::exp(p[2]) : noise.lateral_factor;
  noise.axial_extra = p.size() > 2 ? extra(p[3]) : noise.lateral_extra;
  return noise;
}

Subsets at_most(const Subsets& held_out, std::size_t most) {
  std::size_t total = 0;
  for (const auto& s : held_out) total += s.size();
  Subsets few = held_out;
  if (total > most)
    for (auto& s : few) s.resize((s.size() * most + total - 1) / total);
  return few;
}

// Do lateral and axial uncertainties differ enough to be calibrated apart?
bool has_axis(const Views& views, const std::vector<Eigen::Vector3f>& axes) {
  if (views.planar) return false;
  std::vector<float> ratio;
  for (std::size_t i = 0; i < views.view.size(); ++i) {
    if (views.view[i].covariance.empty()) continue;
    const AxialSigma s = axial_sigma(views.view[i].covariance.front(), axes[i]);
    if (s.lateral > 0) ratio.push_back(std::max(s.axial / s.lateral, s.lateral / std::max(s.axial, 1e-9f)));
  }
  return !ratio.empty() && upper_median(std::move(ratio)) > kAxisRatio;
}

}  // namespace

CalibrationReport calibrate(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                            const Subsets& held_out, const Mixture& mixture, const std::vector<Pose>& poses,
                            const NoiseModel& start) {
  const Subsets few = at_most(held_out, kMostLocalisations);
  double localisations = 0;
  std::vector<int> which;
  std::vector<Pose> pose;
  for (std::size_t i = 0; i < few.size(); ++i) {
    if (few[i].empty()) continue;
    localisations += static_cast<double>(few[i].size());
    which.push_back(static_cast<int>(i));
    pose.push_back(poses[i]);
  }
  if (which.empty()) return {start};
  const auto mean = [&](const NoiseModel& noise) {
    const FusionData data(views, axes, noise, few, which);
    const std::vector<double> per_view = mean_log_likelihood(mixture, data, pose);
    double total = 0;
    for (std::size_t k = 0; k < which.size(); ++k)
      total += per_view[k] * static_cast<double>(few[static_cast<std::size_t>(which[k])].size());
    return total / localisations;
  };
  const auto cost = [&](const Parameters& p) {
    double prior = 0;
    for (std::size_t i = 0; i < p.size(); i += 2) prior += 0.5 * (p[i] / kPriorWidth) * (p[i] / kPriorWidth);
    return prior / localisations - mean(model(p, start));
  };
  const auto first = [&](double factor, double extra, Parameters& p) {
    p.push_back(std::log(factor));
    p.push_back(std::log(std::max(std::hypot(extra, start.width), 2 * kSmallestExtra)));
  };
  Parameters p;
  first(start.lateral_factor, start.lateral_extra, p);
  if (has_axis(views, axes)) first(start.axial_factor, start.axial_extra, p);
  return {model(nelder_mead(p, {kFirstStep, kTolerance, kMostEvaluations}, cost), start)};
}

}  // namespace polar
