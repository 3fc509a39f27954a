// `polar train`: learns the autoencoder's weights (paper IV.A).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/model/train_options.hpp"

namespace polar {

struct TrainReport {
  std::vector<std::int64_t> step;  // the loss curve: mean training loss of the steps up to this one
  std::vector<double> loss;
  std::int64_t steps_done = 0;
  double clouds_per_second = 0;  // of this call
  std::string weights_sha256;    // empty when it stopped before the end
  std::string stopped_because = "never ran";
};

/// Trains for options.steps steps, or goes on from options.checkpoint where that file exists, and writes
/// options.weights. The same options give the same bits for any number of threads and interruptions (on one
/// instruction set). Throws smlm::Error: usage for options that cannot work or a checkpoint of another run,
/// input and io for files, numerical when the loss is no longer finite.
TrainReport train(const TrainOptions& options, Progress& progress);

}  // namespace polar
