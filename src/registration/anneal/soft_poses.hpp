// Poses as a posterior: samples of equal weight for every view, drawn under the density of all posed
// localisations. A sweep is one expectation step (draw poses) and one maximisation step (posed density).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "../data/evidence.hpp"
#include "../data/problem.hpp"
#include "polar/core/pose_prior.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/density_grid.hpp"
#include "polar/fusion/orbits.hpp"
#include "polar/registration/engine_options.hpp"
#include "polar/registration/register.hpp"

namespace polar {

struct SoftPose {
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // template_from_view
  Eigen::Vector3f translation = Eigen::Vector3f::Zero();
};

std::vector<SoftPose> soft_poses_of(const std::vector<Pose>& pose);

struct SoftState {
  std::vector<std::vector<SoftPose>> sample;  // of every view of the problem; empty: takes no part
  std::vector<SoftPose> best;                 // of every view: the likeliest found
  DensityGrid density;
  double outlier_fraction = 0.05;
  double width = 0;     // of the density
  RotationGroup group;  // of the density; empty: none
  explicit SoftState(const VoxelFrame& frame) : density(frame) {}
};

/// One row of the annealing schedule.
struct AnnealStage {
  int sweeps;
  double first_width, last_width, first_beta, last_beta, narrowing;
  bool from_nothing = false;  // few rotations and localisations in the first half
};

/// Of a template that is grown again from few poses.
AnnealStage growth_stage(const EngineOptions& options);

class SoftAnnealer {
 public:
  /// Of the views `which`. The problem outlives the object.
  SoftAnnealer(const Problem& problem, std::vector<int> which, const AnnealOptions& options,
               const PosePrior& prior);

  /// Random poses; `key` tells starts apart.
  SoftState random_start(std::uint64_t key) const;
  /// One sample a view of `posed`: poses from elsewhere. The others take no part yet.
  SoftState from_poses(const std::vector<SoftPose>& pose, const std::vector<int>& posed, double width) const;

  /// The density of the samples, blurred by `width`, symmetric under the state's group.
  void fuse(double width, SoftState& state) const {
    draw_density(counts_of(all_, which_, state), width, state);
  }
  /// From the state's samples.
  void anneal(const AnnealStage& stage, std::uint64_t key, SoftState& state) const;
  /// From the state's density, whatever its samples are.
  void continue_under(const AnnealStage& stage, std::uint64_t key, SoftState& state) const;

  /// Log of the mean over samples of the density of held-out localisations, per localisation; one a view of
  /// `which`. Poses are first drawn again, in two sweeps, from the fitted localisations alone, under the
  /// density of other views' fitted ones.
  Evidence judge(const SoftState& state, std::uint64_t key) const { return judge(state, key, problem_); }
  /// The same by what judges in `drawn`, the problem with other bursts held out.
  Evidence judge(SoftState state, std::uint64_t key, const Problem& drawn) const;

  const std::vector<int>& which() const { return which_; }
  const VoxelFrame& frame() const { return frame_; }

 private:
  struct Draw;
  struct Looked;  // one view, as a sweep looks at it
  struct Grid {
    std::vector<Eigen::Matrix3f> rotation;
    double spacing = 0;  // rad
  };
  std::vector<Draw> candidates(const Looked& view, const Grid& grid, KeyedRandom& random) const;
  std::vector<Draw> followed(const Looked& view, double spacing) const;
  Draw climbed_again(const Looked& view, double spacing, const SoftPose& from) const;
  std::vector<Draw> one_of_every_mode(std::vector<Draw> peaks) const;
  static void weigh(double beta, std::vector<Draw>& found);
  using Points = std::vector<LookupPoints>;  // of every view of the problem
  Points points_of(const Subsets& subsets, int most) const;
  VoxelCounts counts_of(const Points& points, const std::vector<int>& which, const SoftState& state) const;
  void draw_density(const VoxelCounts& counts, double width, SoftState& state) const;
  struct Sweep {
    double beta;
    int rotations, localisations;
    std::uint64_t key;
    bool follows;  // modes of the last sweep only, in which every view took part
  };
  Grid grid_of(const Sweep& sweep, const RotationGroup& group) const;
  void draw_poses(const Points& points, const std::vector<int>& which, const Sweep& sweep,
                  SoftState& state) const;

  const Problem& problem_;
  std::vector<int> which_;
  AnnealOptions options_;
  PosePrior prior_;
  VoxelFrame frame_;
  Points all_;
  std::vector<double> shift_;  // of every view of the problem: standard deviation of its centre
};

}  // namespace polar
