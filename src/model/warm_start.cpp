#include "model/warm_start.hpp"

#include "model/network_step.hpp"

namespace polar {

namespace {
/// `linear` as a layer whose norm has these moments, or (nullptr) as one without a norm.
void undo_folding(const LayerSegments& layer, const Linear& linear, const Moments* norm,
                  std::vector<float>& parameters) {
  view(parameters, layer.weight) = linear.weight;
  vector_view(parameters, layer.shift) = linear.bias;
  if (!norm) return;
  vector_view(parameters, layer.shift) += norm->mean;
  vector_view(parameters, layer.gain) = (norm->variance.array() + kNormEpsilon).sqrt();
}

void undo_folding(const PointNetWeights& weights, TrainState& state) {
  const ParameterLayout& layout = parameter_layout();
  for (std::size_t i = 0; i < 3; ++i) {
    const bool normed = i < 2;
    undo_folding(layout.encoder[i], weights.encoder[i], normed ? &state.moments[i] : nullptr,
                 state.parameters);
    undo_folding(layout.decoder[i], weights.decoder[i], normed ? &state.moments[2 + i] : nullptr,
                 state.parameters);
  }
}
}  // namespace

void start_from(const PointNetWeights& weights, const std::vector<TrainingCloud>& batch, TrainState& state) {
  undo_folding(weights, state);
  NetworkStep network;
  std::vector<float> unused_gradient;
  // What reaches a norm depends on the norms before it, so each pass gets the moments of one more right.
  for (std::size_t pass = 0; pass < state.moments.size(); ++pass) {
    network.loss(state.parameters, batch, {}, unused_gradient);
    network.update(state.moments, 1.0);
    undo_folding(weights, state);
  }
}

}  // namespace polar
