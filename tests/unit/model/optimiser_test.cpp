#include "model/optimiser.hpp"

#include <gtest/gtest.h>

namespace polar {
namespace {

TEST(LearningRate, warmsUpThenFollowsHalfACosine) {
  TrainOptions options;
  options.learning_rate = 0.01;
  options.warmup_steps = 10;
  options.steps = 110;
  TrainState state;
  const auto at = [&](std::int64_t step) {
    state.step = step;
    return learning_rate(options, state);
  };
  EXPECT_NEAR(at(0), 0.001, 1e-12);
  EXPECT_NEAR(at(9), 0.01, 1e-12);
  EXPECT_NEAR(at(10), 0.01, 1e-12);
  EXPECT_NEAR(at(60), 0.005, 1e-12);
  EXPECT_NEAR(at(110), 0, 1e-12);
  options.schedule = "plateau";
  EXPECT_NEAR(at(60), 0.01, 1e-12);
}

TEST(LearningRate, halvesOnAPlateauOnly) {
  TrainOptions options;
  options.schedule = "plateau";
  options.plateau_patience = 3;
  TrainState state;
  for (const double loss : {0.5, 0.4, 0.41, 0.42}) update_plateau(options, loss, state);
  EXPECT_EQ(state.rate_factor, 1);
  update_plateau(options, 0.39, state);  // an improvement starts the count again
  for (const double loss : {0.39, 0.39}) update_plateau(options, loss, state);
  EXPECT_EQ(state.rate_factor, 1);
  update_plateau(options, 0.39, state);
  EXPECT_EQ(state.rate_factor, 0.5);
  EXPECT_EQ(state.best_loss, 0.39);
}

TEST(AdamwStep, movesAgainstTheGradientAndDecaysMatricesAlone) {
  TrainOptions options;
  options.warmup_steps = 0;
  options.weight_decay = 0.5;
  options.learning_rate = 0.1;
  TrainState state = initial_state(options);
  const std::vector<float> before = state.parameters;
  std::vector<float> gradient(before.size(), 0.0f);
  const std::size_t shift = parameter_layout().decoder[2].shift.begin;
  const std::size_t weight = parameter_layout().decoder[0].weight.begin;
  const std::size_t gain = parameter_layout().encoder[1].gain.begin;
  gradient[shift] = 3;
  adamw_step(options, gradient, state);
  EXPECT_NEAR(state.parameters[shift], before[shift] - 0.1f, 1e-5f);  // the first step has the rate's length
  EXPECT_NEAR(state.parameters[weight], before[weight] * (1 - 0.1f * 0.5f), 1e-6f);
  EXPECT_EQ(state.parameters[gain], before[gain]);
}

}  // namespace
}  // namespace polar
