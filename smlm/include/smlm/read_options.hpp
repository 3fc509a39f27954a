// How tables are to be read: the `input:` section of a configuration without its list of files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "smlm/blink_group.hpp"
#include "smlm/channel.hpp"
#include "smlm/particle_limits.hpp"
#include "smlm/pick.hpp"
#include "smlm/row_filter.hpp"

namespace smlm {

/// Where a quantity stands in a table whose header says nothing, or says it wrongly.
struct ColumnMapping {
  std::string name;  // the column's header, or its 1-based number in a table without header
  std::string unit;  // nm, um, mm, m, px or angstrom (squared for variances); empty: as the header says
  std::string kind;  // std | variance, of uncertainties; empty: as the header says, else std
};

struct ReadOptions {
  /// auto, or the name of a reader: csv, thunderstorm, picasso, smap, ... (see table_readers()).
  std::string format = "auto";
  /// Canonical name (x, y, z, sigma_x, sigma_xy, sigma_xx, particle, ...) -> column. Wins over the header; a
  /// mapped uncertainty replaces the header's of the same axes, a covariance all of them.
  std::map<std::string, ColumnMapping> columns;
  /// Nanometres per camera pixel, for whatever is in pixels; 0: as the file says.
  double pixel_size_nm = 0;
  /// Unit of lengths that nothing tells the unit of; empty: nm, with a warning.
  std::string unit;
  /// What uncertainties are that nothing tells the kind of (.mat files): std | variance; empty: std, with a
  /// warning where files of that kind hold either.
  std::string sigma_kind;
  /// Whether z is ignored, so that everything is registered in the plane; without it a table is planar where
  /// its z says nothing (absent, empty, or the same everywhere).
  bool planar = false;
  /// Unit of Picasso's lpz, which its versions disagree on: nm | px.
  std::string lpz_unit = "nm";
  /// column: a column names the particle of each row; one_per_file: a file is a particle; picked: particles
  /// are picked out of each file's field of view.
  std::string particles = "column";
  /// How, where particles are picked.
  PickOptions pick;
  /// Particle ids that mean "none", beside those that always do: negative numbers, empty, nan, NA, None,
  /// null. Empty: 0 in SMAP's sitenumbers, else no other.
  std::vector<std::string> unassigned_particle;
  /// Leave out rows whose position or uncertainty cannot be used, and count them; else they are an error.
  bool drop_nonfinite = false;
  /// Rows are left out whose value lies outside of [low, high] (see filter_rows), before anything else is
  /// made of them.
  std::map<std::string, Bounds> filters;
  /// How localisations of one molecule in consecutive frames are merged, after the filters.
  BlinkOptions group;
  /// Which rows are of which channel, and which channels decide the poses.
  ChannelOptions channel;
  /// What a particle must be to be registered.
  ParticleLimits particle_limits;
  /// Lateral standard deviation given to tables without any uncertainty, nm; the axial one is twice that.
  double assumed_sigma_nm = 10;
  /// Factor on MINFLUX z for the refractive index mismatch; 1 keeps z as measured.
  double minflux_z_factor = 0.7;
  /// Only where points are, not how well: for centres of picks and for structures. No key of a configuration.
  bool positions_only = false;
};

/// One sentence per fault, each starting with its key; empty when the options can be used.
std::vector<std::string> violations(const ReadOptions& options);

}  // namespace smlm
