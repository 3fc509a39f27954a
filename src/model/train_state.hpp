// What a training is between two steps, and its checkpoint file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/parameters.hpp"
#include "polar/model/train_options.hpp"

namespace polar {

struct TrainState {
  std::vector<float> parameters, first_moment, second_moment;  // the last two are AdamW's
  RunningMoments moments;
  std::int64_t step = 0;
  double rate_factor = 1;   // of the plateau schedule
  double best_loss = 1e30;  // of the reports
  std::int64_t reports_since_best = 0;
  double loss_sum = 0;          // since the last report
  std::int64_t loss_steps = 0;  // how many steps that is
  std::vector<std::int64_t> curve_step;
  std::vector<double> curve_loss;
};

TrainState initial_state(const TrainOptions& options);

/// Atomic: an interrupted write leaves the previous checkpoint.
void write_checkpoint(const std::string& path, const TrainOptions& options, const TrainState& state);

/// Throws smlm::Error (usage) where the checkpoint belongs to a run with another seed or batch size.
TrainState read_checkpoint(const std::string& path, const TrainOptions& options);

}  // namespace polar
