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
  double posterior_share = PoseRow::kNone;  // of the pose's posterior that lies at this pose
};

/// What a particle's pose came to: of one that was not accepted, to see what a cut-off cuts off.
struct ParticleScores {
  double log_likelihood = PoseRow::kNone, margin = PoseRow::kNone;
  double rotation_std_deg = PoseRow::kNone, translation_std_nm = PoseRow::kNone;
  ParticleFit fit;
};

/// Where labels were counted, and how many there are.
struct LabellingRecord {
  std::string of;  // sites | symmetric units
  double efficiency = PoseRow::kNone, low = PoseRow::kNone, high = PoseRow::kNone;
  int labels_per_site = 1;
  std::vector<double> occupancy;       // of every place
  std::vector<double> particles_with;  // [n]: particles with n labelled places, expected
  std::vector<double> labels_of;       // [k]: labelled places with k localisations, expected
};

struct StartRecord {
  std::string name;
  double held_out = 0;                   // nat a localisation
  double held_out_std = PoseRow::kNone;  // standard error of what it gains over the best before it
  bool won = false;
};

/// One round of the registration.
struct RoundRecord {
  double width_nm = PoseRow::kNone;                         // of the template
  double moved = PoseRow::kNone, escaped = PoseRow::kNone;  // particles
  double held_out = PoseRow::kNone;                         // nat a localisation
};

struct SymmetryRecord {
  std::string group;
  bool imposed = false;  // template and poses have it
  bool asked = false;    // named in the configuration
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
  std::vector<ParticleScores> refused;                   // poses that were found and not accepted
  double least_posterior_share = PoseRow::kNone, most_rotation_std_deg = PoseRow::kNone,
         most_outliers = PoseRow::kNone;  // what a pose had to keep to
  std::optional<LabellingRecord> labelling;
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
  std::string channel_column;             // of the superparticle, where it holds several channels
  std::string command, machine, weights_sha256;
  std::vector<std::string> input_file, input_sha256;  // parallel
};

/// Reads a record. Throws smlm::Error (input) for a file that is none, of a later format, or damaged.
RunRecord read_run_record(const std::string& path);

/// How many particles have a pose.
std::size_t accepted_particles(const RunRecord& record);

}  // namespace polar
