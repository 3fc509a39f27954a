// One step of training: loss and gradient of the whole autoencoder on a batch.
#pragma once

#include <cstdint>
#include <vector>

#include "model/decoder_step.hpp"
#include "model/encoder_step.hpp"
#include "model/parameters.hpp"
#include "model/training_cloud.hpp"

namespace polar {

class NetworkStep {
 public:
  /// Mean Chamfer distance (sum of both ways, paper eq. for d_CD) of D(E(input)) and target over the batch;
  /// `gradient` receives its derivative in every parameter.
  double loss(const std::vector<float>& parameters, const std::vector<TrainingCloud>& batch,
              const DropoutKey& dropout, std::vector<float>& gradient);

  /// running += momentum (this batch's moments - running), variances unbiased.
  void update(RunningMoments& running, double momentum) const;

 private:
  EncoderStep encoder_;
  DecoderStep decoder_;
  double points_ = 0, clouds_ = 0;
};

}  // namespace polar
