// What `polar train` can be told. Every option has a default; violations() lists what cannot work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace polar {

/// Which clouds the network learns from.
struct TrainData {
  std::vector<std::string> shapes;  // HDF5 files: `points` (shape, point, 3) times attribute `scale`
  double procedural_share = 0.5;    // share of clouds from the procedural generator; 1 where no file is given
  double stretch_share = 0.5;       // share of file shapes that are stretched by up to 1.6 along random axes
  double sites_share = 0.2;  // share of procedural clouds that are sites of labels: rings and polyhedra ...
  double grid_share = 0;     // ... or, this share of them, flat grids as of DNA origami
};

/// How a clean cloud is spoilt before the encoder sees it; lengths in units of the clean cloud's largest
/// radius.
struct Degradation {
  int min_points = 50;  // points kept, log-uniform between min and max ...
  int max_points = 1024;
  double full_share = 0.4;    // ... except for this share of clouds, which keep max_points
  double clean_share = 0.15;  // share of clouds without noise
  double max_sigma = 0.1;     // noise: standard deviation log-uniform in [0.005, max_sigma]
  double anisotropic_share =
      0.4;                       // share of noisy clouds whose noise is 1.5 to 6 times larger along one axis
  double per_point_share = 0.5;  // share of noisy clouds whose sigma varies from point to point
  double uneven_share = 0.3;     // share of clouds whose density varies in space
  double cut_share = 0.5;        // share of clouds cut by a plane ...
  double min_visibility = 0.7;   // ... that leaves v ~ U(min_visibility, 1) of the points
  double recentre_share = 0.5;   // share of clouds that are centred again after all this
  double rescale_share = 0.4;    // share of clouds scaled by U(0.7, 1)
  double few_labels_share = 0;   // share of clouds whose points repeat few labels, as blinking does ...
  int min_labels = 8;            // ... their number log-uniform between min and max
  int max_labels = 200;
};

struct TrainOptions {
  std::uint64_t seed = 1;
  TrainData data;
  Degradation degradation;
  int clouds_per_step = 64;  // the batch of the batch norms
  std::int64_t steps = 20000;
  double learning_rate = 1e-3;
  std::string schedule = "cosine";  // cosine | plateau (halved when the loss does not improve)
  int warmup_steps = 200;           // the rate rises linearly over these
  int plateau_patience = 10;        // reports without improvement before the rate is halved
  double weight_decay = 1e-2;       // AdamW's, on weight matrices only
  double dropout = 0.1;             // in the decoder
  double batch_norm_momentum = 0.02;
  std::string initial_weights;  // weights file to start from; empty: random ones
  int report_every_steps = 100;
  int checkpoint_every_steps = 500;
  std::string checkpoint;                 // file that an interrupted training goes on from; empty: none
  std::vector<std::string> score_shapes;  // shape files that only judge the result, never train it
  std::string weights = "weights.h5";     // the result
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const TrainOptions& options);

}  // namespace polar
