// Everything the trainer learns, in one flat array, so that the optimiser and the checkpoint need not know
// what it means. Linear layers that feed a batch norm have no bias: the norm's shift is their bias.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/kernel_table.hpp"
#include "polar/model/pointnet.hpp"

namespace polar {

/// A part of the flat array.
struct Segment {
  std::size_t begin = 0;
  Eigen::Index rows = 0, columns = 0;
  std::size_t size() const { return static_cast<std::size_t>(rows * columns); }
};

/// A weight matrix and what follows it: gain and shift of the batch norm, or (gain empty) the bias alone.
struct LayerSegments {
  Segment weight, gain, shift;
};

struct ParameterLayout {
  ParameterLayout();
  std::array<LayerSegments, 3> encoder, decoder;
  std::size_t size = 0;
};

const ParameterLayout& parameter_layout();

using MatrixMap = Eigen::Map<RowMatrixXf>;
using ConstMatrixMap = Eigen::Map<const RowMatrixXf>;

inline ConstMatrixMap view(const std::vector<float>& flat, const Segment& s) {
  return {flat.data() + s.begin, s.rows, s.columns};
}
inline MatrixMap view(std::vector<float>& flat, const Segment& s) {
  return {flat.data() + s.begin, s.rows, s.columns};
}
inline Eigen::Map<const Eigen::VectorXf> vector_view(const std::vector<float>& flat, const Segment& s) {
  return {flat.data() + s.begin, s.rows};
}
inline Eigen::Map<Eigen::VectorXf> vector_view(std::vector<float>& flat, const Segment& s) {
  return {flat.data() + s.begin, s.rows};
}

/// Mean and variance of a batch norm's input, one entry a channel.
struct Moments {
  Eigen::VectorXf mean, variance;
};

/// The four batch norms' running moments: encoder 0, 1, decoder 0, 1.
using RunningMoments = std::array<Moments, 4>;

constexpr float kNormEpsilon = 1e-5f;  // the usual one, also that of the reference

/// Weights drawn from U(-1, 1) / sqrt(inputs), gains 1, shifts 0; moments 0 and 1.
std::vector<float> initial_parameters(std::uint64_t seed);
RunningMoments initial_moments();

/// What inference uses: the batch norms folded into the layers before them.
PointNetWeights folded(const std::vector<float>& parameters, const RunningMoments& moments);

/// weight and shift of one layer with its norm folded in.
Linear fold(const ConstMatrixMap& weight, const Eigen::Ref<const Eigen::VectorXf>& gain,
            const Eigen::Ref<const Eigen::VectorXf>& shift, const Moments& moments);

}  // namespace polar
