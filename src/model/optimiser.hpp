// AdamW (I. Loshchilov, F. Hutter, Decoupled weight decay regularization, ICLR 2019) and its rate.
#pragma once

#include <vector>

#include "model/train_state.hpp"
#include "polar/model/train_options.hpp"

namespace polar {

/// The rate of step `step` (from 0): linear warm-up, then half a cosine down to 0, or learning_rate times the
/// plateau's factor.
double learning_rate(const TrainOptions& options, const TrainState& state);

/// Halves the rate when `loss` (of a report) has not improved for plateau_patience reports.
void update_plateau(const TrainOptions& options, double loss, TrainState& state);

/// One step along `gradient`; weight matrices alone decay.
void adamw_step(const TrainOptions& options, const std::vector<float>& gradient, TrainState& state);

}  // namespace polar
