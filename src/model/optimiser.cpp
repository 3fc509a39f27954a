#include "model/optimiser.hpp"

#include <algorithm>
#include <cmath>

#include "model/kernel_table.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {
constexpr double kBeta1 = 0.9, kBeta2 = 0.999;  // the usual ones, also those of the reference
constexpr float kEpsilon = 1e-8f;
constexpr double kImprovement = 1e-4;    // relative; smaller gains do not count on a plateau
constexpr std::size_t kBlock = 1 << 16;  // parameters that one task updates
}  // namespace

double learning_rate(const TrainOptions& options, const TrainState& state) {
  const double step = static_cast<double>(state.step), warmup = options.warmup_steps;
  double rate = options.learning_rate * state.rate_factor;
  if (step < warmup) return rate * (step + 1) / warmup;
  if (options.schedule == "cosine") {
    const double span = std::max(1.0, static_cast<double>(options.steps) - warmup);
    rate *= 0.5 * (1 + std::cos(kPi * std::min(1.0, (step - warmup) / span)));
  }
  return rate;
}

void update_plateau(const TrainOptions& options, double loss, TrainState& state) {
  if (loss < state.best_loss * (1 - kImprovement)) {
    state.best_loss = loss;
    state.reports_since_best = 0;
    return;
  }
  if (++state.reports_since_best < options.plateau_patience) return;
  state.reports_since_best = 0;
  if (options.schedule == "plateau") state.rate_factor /= 2;
}

void adamw_step(const TrainOptions& options, const std::vector<float>& gradient, TrainState& state) {
  const double rate = learning_rate(options, state), t = static_cast<double>(state.step + 1);
  kernel::AdamStep step{static_cast<float>(rate),
                        static_cast<float>(kBeta1),
                        static_cast<float>(kBeta2),
                        kEpsilon,
                        0.0f,
                        static_cast<float>(1 - std::pow(kBeta1, t)),
                        static_cast<float>(1 - std::pow(kBeta2, t))};
  const auto update = [&](const Segment& segment, double decay) {
    step.decay = static_cast<float>(rate * decay);
    parallel_blocks(segment.size(), kBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
      const std::size_t at = segment.begin + begin;
      kernel::active_table().adamw(static_cast<long>(end - begin), state.parameters.data() + at,
                                   gradient.data() + at, state.first_moment.data() + at,
                                   state.second_moment.data() + at, step);
    });
  };
  for (const auto* part : {&parameter_layout().encoder, &parameter_layout().decoder})
    for (const LayerSegments& layer : *part) {
      update(layer.weight, options.weight_decay);
      update(layer.gain, 0);
      update(layer.shift, 0);
    }
}

}  // namespace polar
