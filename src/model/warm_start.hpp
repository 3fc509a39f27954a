// Training that starts from finished weights, e.g. the shipped ones, on the user's own structures.
#pragma once

#include <vector>

#include "model/train_state.hpp"
#include "model/training_cloud.hpp"
#include "polar/model/pointnet.hpp"

namespace polar {

/// Parameters and moments of `state` such that the network with batch norms computes what `weights`, whose
/// norms are folded in, computes: moments are those of `batch`, gains and shifts undo them.
void start_from(const PointNetWeights& weights, const std::vector<TrainingCloud>& batch, TrainState& state);

}  // namespace polar
