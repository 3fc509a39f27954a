// The decoder with batch norms over the clouds of a batch and dropout, forward and backward.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "model/parameters.hpp"

namespace polar {

/// Whose dropout this is: cloud i of the batch draws from (seed, first_item + i).
struct DropoutKey {
  std::uint64_t seed = 0, first_item = 0;
  double rate = 0;
};

class DecoderStep {
 public:
  /// Clouds x 3072 coordinates for latent vectors clouds x 1024.
  RowMatrixXf forward(const std::vector<float>& parameters, const RowMatrixXf& latent,
                      const DropoutKey& dropout);

  /// Writes the decoder's part of `gradient` for dL/doutput and returns dL/dlatent; after forward().
  RowMatrixXf backward(const std::vector<float>& parameters, const RowMatrixXf& output_gradient,
                       std::vector<float>& gradient) const;

  const Moments& moments(std::size_t norm) const { return hidden_[norm].moments; }

 private:
  struct Hidden {
    RowMatrixXf input;       // of the linear layer
    RowMatrixXf normalised;  // its output after the norm, before gain and shift
    RowMatrixXf passed;      // 0, or 1 / (1 - dropout), times relu'
    RowMatrixXf output;
    Moments moments;
  };
  std::array<Hidden, 2> hidden_;
};

}  // namespace polar
