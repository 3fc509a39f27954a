// All that a page tells of a run, as results.h5 holds it. What a record lacks is empty, NaN or absent here,
// and the page says so.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"
#include "polar/results/resolution.hpp"
#include "polar/results/result_file.hpp"

namespace polar {

/// The particles' own state beside their row in poses.csv.
struct ParticleFit {
  double outlier_fraction = PoseRow::kNone, visibility = PoseRow::kNone;
  /// Spread of the pose's posterior over all poses, where it was computed: more than the local covariance
  /// tells.
  double posterior_rotation_deg = PoseRow::kNone, posterior_translation_nm = PoseRow::kNone;
};

struct StartRecord {
  std::string name;
  double held_out = 0;                      // nat a localisation
  double held_out_std = PoseRow::kNone;     // standard error of what it gains over the best before it
  bool won = false;
};

/// One round of the registration.
struct RoundRecord {
  double moved = PoseRow::kNone, escaped = PoseRow::kNone;  // particles
  double log_likelihood = PoseRow::kNone;
};

struct SymmetryRecord {
  std::string group;
  bool imposed = false;
  double gain = PoseRow::kNone, gain_std = PoseRow::kNone;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // x_canonical = rotation (x_template - centre)
  Eigen::Vector3d centre_nm = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd unit_nm;  // template frame
  std::vector<std::string> tried_group;
  std::vector<double> tried_gain, tried_gain_std;
};

struct RunRecord {
  ResultRecord result;  // superparticle, template, calibration, configuration
  std::vector<PoseRow> poses;
  std::vector<ParticleFit> fit;                          // one a pose
  std::vector<std::array<double, 3>> rejected_position;  // nm, in the table's coordinates
  std::vector<std::int64_t> rejected_particle;           // row of poses
  std::optional<SymmetryRecord> symmetry;
  std::optional<ResolutionReport> resolution;
  std::vector<double> curve_particles, curve_resolution_nm;  // resolution of ever more particles
  std::vector<StartRecord> starts;
  double agreement = 0;  // see Registration::agreement
  std::vector<RoundRecord> history;
  std::vector<std::string> stage;
  std::vector<double> stage_seconds;
  int rounds = 0;
  bool converged = false;
  std::string stopped_because;
  std::vector<std::string> warnings, libraries;
  std::vector<std::string> rejected_rows_reason;  // rows that were left out while reading
  std::vector<std::uint64_t> rejected_rows;
  std::uint64_t seed = 0;
  std::string verdict, verdict_sentence;  // found | ambiguous | none; empty: left to the page
  std::string channel_column;            // of the superparticle, where it holds several channels
  std::string command, machine, weights_sha256;
  std::vector<std::string> input_file, input_sha256;  // parallel
};

/// Reads a record. Throws smlm::Error (input) for a file that is none, of a later format, or damaged.
RunRecord read_run_record(const std::string& path);

/// How many particles have a pose.
std::size_t accepted_particles(const RunRecord& record);

}  // namespace polar
