// Everything a run knows at its end, and the step from the engine's units to the table's nanometres.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/view.hpp"
#include "polar/registration/engine_options.hpp"
#include "polar/registration/registration.hpp"
#include "polar/results/labelling.hpp"
#include "polar/results/pose_table.hpp"
#include "polar/results/resolution.hpp"
#include "smlm/particle_set.hpp"

namespace polar {

/// What produced a result, so that it can be made again.
struct Provenance {
  std::string program;        // name, version, commit
  std::string configuration;  // effective, YAML
  std::uint64_t seed = 0;
  std::string input_hash;              // of the files' content and the configuration (see pipeline)
  std::vector<std::string> libraries;  // "HDF5 1.10.8", ...
  std::string command{}, machine{};    // as typed; processor, threads, memory, system
  std::vector<std::string> input_file{}, input_sha256{};  // parallel: everything that was read
};

/// How many of the places of a template carry a label.
struct LabelledPlaces {
  Labelling labelling;
  PlaceCounts counts;
  Eigen::Matrix3Xd place_nm;  // 3 x places, template frame
};

/// A run's result. particles.particles, normalisation.centre_nm and registration.view are parallel: one
/// entry a particle, in the order of the input.
struct Results {
  smlm::ParticleSet particles;
  Normalisation normalisation;
  bool planar = false;
  std::string channel_column;                     // of the table, where it holds several channels; else empty
  std::vector<std::string> registering_channels;  // that decided the poses, as asked for; empty: the first
  Registration registration;
  Provenance provenance;
  std::optional<ResolutionReport> resolution;  // where output.resolution asks for it
  std::optional<LabelledPlaces> labelled;      // where the template is discrete, or has symmetric units
  VerdictOptions limits;                       // that a pose had to keep to be accepted
};

/// How many particles have a pose that may be used.
std::size_t accepted_particles(const Results& results);

/// R C R^T of a stored covariance.
smlm::Covariance rotated(const Eigen::Matrix3d& r, const smlm::Covariance& c);

/// Of a table, what rendering needs of the rows that are wanted.
smlm::LocalisationTable rows_to_draw(const smlm::LocalisationTable& table, const std::vector<bool>& wanted);

/// A table moved by a pose (nm), covariances turned along; the z of a planar table stays.
smlm::LocalisationTable moved(smlm::LocalisationTable table, const Pose& pose);

/// The engine's pose of particle i in nm: x_template = R x_nm + t_nm with x_nm as in the table and the
/// template frame = scale_nm * engine frame.
Pose template_from_table(const Results& results, std::size_t i);

/// Covariance of that pose (rotation rad, translation nm), left perturbation in the template frame.
Eigen::Matrix<double, 6, 6> pose_covariance_nm(const Results& results, std::size_t i);

/// The rows of poses.csv; rejected particles have no pose.
std::vector<PoseRow> pose_rows(const Results& results);

/// The fused template in nm.
struct TemplateSites {
  Eigen::Matrix3Xd centre_nm;  // 3 x K
  Eigen::VectorXd weight;      // K, sum 1
  double width_nm = 0;         // standard deviation of every centre
};
TemplateSites template_sites(const Results& results);

/// Every localisation of the particles that have a pose (one a particle, to the template from the table's own
/// nanometres) in the template frame, with its covariance rotated along; all other columns, source files and
/// rows as in the input.
smlm::LocalisationTable aligned(const smlm::ParticleSet& particles,
                                const std::vector<std::optional<Pose>>& template_from_table);

/// The superparticle: the accepted particles, aligned.
smlm::LocalisationTable superparticle(const Results& results);

}  // namespace polar
