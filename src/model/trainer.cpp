#include "polar/model/trainer.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "model/network_step.hpp"
#include "model/optimiser.hpp"
#include "model/train_state.hpp"
#include "model/warm_start.hpp"
#include "polar/core/parallel.hpp"
#include "polar/model/shapes.hpp"
#include "polar/model/weights_file.hpp"
#include "smlm/error.hpp"
#include "smlm/isolation.hpp"

namespace polar {

namespace {
constexpr int kCleanPoints = 1024;
constexpr std::size_t kStatisticsClouds = 512;         // the decoder's norms have one value a cloud
constexpr std::uint64_t kStatisticsItem = 1ull << 62;  // of clouds that no step sees
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string report_line(const TrainState& state, const TrainOptions& options, double clouds_per_second) {
  const double left =
      static_cast<double>(options.steps - state.step) * options.clouds_per_step / clouds_per_second;
  char line[160];
  std::snprintf(line, sizeof line, "step %lld of %lld, Chamfer %.4f, rate %.2e, %.0f clouds/s, %.0f min left",
                static_cast<long long>(state.step), static_cast<long long>(options.steps),
                state.curve_loss.back(), learning_rate(options, state), clouds_per_second, left / 60);
  return line;
}

std::string about(const TrainOptions& options, const TrainState& state) {
  char text[256];
  std::snprintf(text, sizeof text, "seed %llu, %lld steps of %d clouds, training Chamfer %.4f",
                static_cast<unsigned long long>(options.seed), static_cast<long long>(state.step),
                options.clouds_per_step, state.curve_loss.empty() ? NAN : state.curve_loss.back());
  return text;
}

/// Examples number `first_item` and those after it, as many as `batch` holds.
void draw(const TrainOptions& options, const ShapeSet& shapes, std::uint64_t first_item,
          std::vector<TrainingCloud>& batch) {
  parallel_for(batch.size(), [&](std::size_t i) {
    batch[i] = training_cloud(options.seed, first_item + i, options.data, shapes, options.degradation);
  });
}

/// Random weights, or those of options.initial_weights with the statistics of clouds like those to come.
TrainState first_state(const TrainOptions& options, const ShapeSet& shapes) {
  TrainState state = initial_state(options);
  if (options.initial_weights.empty()) return state;
  std::vector<TrainingCloud> batch(kStatisticsClouds);
  draw(options, shapes, kStatisticsItem, batch);
  const std::string& path = options.initial_weights;
  start_from(smlm::read_isolated(path, [&] { return read_weights(path); }).weights, batch, state);
  return state;
}
}  // namespace

TrainReport train(const TrainOptions& options, Progress& progress) {
  smlm::throw_if_any(violations(options), smlm::Fault::usage, "training options");
  const ShapeSet shapes = read_shapes(options.data.shapes, kCleanPoints);
  const bool resume = !options.checkpoint.empty() && std::ifstream(options.checkpoint).good();
  TrainState state = resume ? read_checkpoint(options.checkpoint, options) : first_state(options, shapes);
  if (resume) progress.note("going on from step " + std::to_string(state.step) + " of " + options.checkpoint);

  const auto clouds = static_cast<std::size_t>(options.clouds_per_step);
  NetworkStep network;
  std::vector<TrainingCloud> batch(clouds);
  std::vector<float> gradient;
  TrainReport report;
  const Clock::time_point start = Clock::now();
  const std::int64_t first = state.step;
  const auto rate = [&](std::int64_t from, Clock::time_point since) {
    return static_cast<double>((state.step - from) * options.clouds_per_step) / seconds_since(since);
  };
  std::int64_t reported = first;  // the rate of a report is that of the steps since the last one
  Clock::time_point report_time = start;
  while (state.step < options.steps && !progress.cancelled()) {
    const std::uint64_t item = static_cast<std::uint64_t>(state.step) * clouds;
    draw(options, shapes, item, batch);
    const double loss =
        network.loss(state.parameters, batch, {options.seed, item, options.dropout}, gradient);
    if (!std::isfinite(loss))
      throw smlm::Error(smlm::Fault::numerical, "training",
                        "the loss is not finite at step " + std::to_string(state.step),
                        "lower learning_rate and go on from the last checkpoint");
    adamw_step(options, gradient, state);
    network.update(state.moments, options.batch_norm_momentum);
    state.loss_sum += loss;
    ++state.loss_steps;
    ++state.step;
    if (state.step % options.report_every_steps == 0) {
      state.curve_step.push_back(state.step);
      state.curve_loss.push_back(state.loss_sum / static_cast<double>(state.loss_steps));
      state.loss_sum = 0;
      state.loss_steps = 0;
      update_plateau(options, state.curve_loss.back(), state);
      progress.note(report_line(state, options, rate(reported, report_time)));
      reported = state.step;
      report_time = Clock::now();
    }
    progress.step("train", static_cast<int>(state.step), static_cast<int>(options.steps));
    const bool last = state.step == options.steps || progress.cancelled();
    if (!options.checkpoint.empty() && (last || state.step % options.checkpoint_every_steps == 0))
      write_checkpoint(options.checkpoint, options, state);
  }
  report.step = state.curve_step;
  report.loss = state.curve_loss;
  report.steps_done = state.step;
  report.clouds_per_second = state.step > first ? rate(first, start) : 0;
  const bool complete = state.step >= options.steps;
  report.stopped_because = complete ? "all steps done" : "it was interrupted";
  if (complete)
    report.weights_sha256 = write_weights(options.weights, folded(state.parameters, state.moments),
                                          Precision::half, about(options, state));
  return report;
}

}  // namespace polar
