#include "polar/fitting/evidence.hpp"

#include <cmath>

#include "halves.hpp"
#include "likelihood.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "registration/data/evidence.hpp"

namespace polar::fitting {

namespace {
constexpr std::uint32_t kHalfStage = 0xf3;
constexpr int kReweightings = 4, kWeightSteps = 3;
constexpr std::size_t kFewest = 10;  // localisations that a particle needs to be split
constexpr double kLeastWeight =
    1e-4;  // of the mean: a centre that the other half does not show is not ruled out

// The free template as a model without geometry: sites with weights, a width and a background.
GeometricModel as_model(const FreeTemplate& free) {
  GeometricModel model = empty_model();
  model.parameter[kWidth].shared = false;
  Part sites;
  sites.shape = Shape::sites;
  sites.argument = {Expression(1.0)};
  sites.placement.assign(placement_arguments().size(), Expression(0.0));
  sites.site_nm = free.centre_nm, sites.site_weight = free.weight;
  model.part = {sites};
  return model;
}

GeometricModel all_shared(GeometricModel model) {
  for (ModelParameter& p : model.parameter) p.shared = true;
  return model;
}

GeometricModel none_shared(GeometricModel model) {
  for (ModelParameter& p : model.parameter) p.shared = false;
  return model;
}

// Weights by expectation maximisation in turn with width and background, poses and centres held.
ModelFit reweighted(GeometricModel& model, const FitData& data, double width_nm) {
  FitOptions held;
  held.free_pose = false;
  ModelFit fit;
  fit.value.resize(2);
  fit.value << std::max(width_nm, model.parameter[kWidth].low), 0.05;
  Eigen::VectorXd& weight = model.part[0].site_weight;
  for (int round = 0; round < kReweightings; ++round) {
    for (int step = 0; step < kWeightSteps; ++step) {
      Eigen::VectorXd theta = Eigen::VectorXd::Zero(2 + kPlacement);
      theta.head<2>() = fit.value;
      weight = responsibilities(data, density_of(model, {{1, 1}}, fit.data_from_model, theta, false));
      weight.array() += kLeastWeight * weight.mean();
      weight /= weight.sum();
    }
    fit = fit_near(model, data, fit, held);
  }
  return fit;
}

double judged(const GeometricModel& model, const Halves& s, const ModelFit& near, const FitOptions& options) {
  return mean_log_density(model, s.judging, fit_near(model, s.fitted, near, options));
}
Gain gain_of(const std::vector<double>& over, const std::vector<double>& evidence) {
  const Comparison c = compare(over, evidence);
  return {c.gain, c.standard_error, c.views};
}
}  // namespace

ModelEvidence judge_model(const GeometricModel& model, const std::vector<FitData>& particles,
                          const ModelFit& all, const FreeTemplate* free, const FitOptions& options) {
  ModelEvidence out;
  out.common.assign(particles.size(), NAN), out.own = out.common;
  if (free) out.free = out.common;
  const auto order = random_order(particles.size(), KeyedRandom(options.seed, 0, kHalfStage));
  FitOptions placed = options;
  placed.free_pose = false;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<FitData> others;
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < order.size(); ++i)
      if (particles[order[i]].size() >= kFewest) {
        if (i % 2 == half)
          own.push_back(order[i]);
        else
          others.push_back(particles[order[i]]);
      }
    if (others.empty() || own.empty()) continue;
    const FitData other_half = superparticle_of(others);
    const ModelFit common = fit_near(none_shared(model), other_half, all, placed);
    GeometricModel free_model;
    ModelFit free_fit;
    if (free) {
      free_model = as_model(*free);
      free_fit = reweighted(free_model, other_half, free->width_nm);
      free_model = all_shared(free_model);
    }
    parallel_for(own.size(), [&](std::size_t k) {
      const std::size_t i = own[k];
      const Halves s = halves_of(particles[i], options.seed, i);
      if (s.fitted.size() == 0 || s.judging.size() == 0) return;
      out.common[i] = judged(all_shared(model), s, common, options);
      out.own[i] = judged(model, s, common, options);
      if (free) out.free[i] = judged(free_model, s, free_fit, options);
    });
  }
  out.own_over_common = gain_of(out.common, out.own);
  if (free) out.free_over_common = gain_of(out.common, out.free);
  return out;
}

}  // namespace polar::fitting
