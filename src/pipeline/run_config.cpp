#include "polar/pipeline/run_config.hpp"

#include <algorithm>
#include <utility>

#include "config/fields.hpp"
#include "config/paths.hpp"
#include "engine_fields.hpp"
#include "polar/pipeline/outputs.hpp"
#include "run_config_tree.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
template <class Visitor>
void fields(Visitor& v, RunConfig& c) {
  v.section("input", [&](auto& s) {
    smlm::ReadOptions& o = c.read;
    s.field("files", c.files);
    s.field("format", o.format);
    s.entries("columns", o.columns, [](auto& column, smlm::ColumnMapping& mapping) {
      column.field("name", mapping.name);
      column.field("unit", mapping.unit);
      column.field("kind", mapping.kind);
    });
    s.field("pixel_size_nm", o.pixel_size_nm);
    s.field("unit", o.unit);
    s.field("sigma_kind", o.sigma_kind);
    s.field("planar", o.planar);
    s.field("lpz_unit", o.lpz_unit);
    s.field("particles", o.particles);
    s.section("pick", [&](auto& pick) {
      pick.field("radius_nm", o.pick.radius_nm);
      pick.field("centres", o.pick.centres);
      pick.field("min_localisations", o.pick.min_localisations);
    });
    s.field("unassigned_particle", o.unassigned_particle);
    s.field("drop_nonfinite", o.drop_nonfinite);
    s.bounds("filters", o.filters);
    s.section("group", [&](auto& group) {
      group.field("distance", o.group.distance);
      group.field("dark_frames", o.group.dark_frames);
    });
    s.section("channel", [&](auto& channel) {
      channel.field("column", o.channel.column);
      channel.field("per_file", o.channel.per_file);
      channel.field("register", o.channel.registering);
    });
    s.section("particle_limits", [&](auto& limits) {
      limits.bounds("localisations", o.particle_limits.localisations);
      limits.bounds("radius_nm", o.particle_limits.radius_nm);
    });
    s.field("assumed_sigma_nm", o.assumed_sigma_nm);
    s.field("minflux_z_factor", o.minflux_z_factor);
  });
  v.section("registration", [&](auto& s) {
    RegistrationOptions& o = c.registration;
    s.field("seed", o.seed);
    s.field("starts", o.starts);
    s.field("method", o.method);
    s.field("search", o.search);
    s.field("optimizer", o.optimizer);
    s.field("symmetry", o.symmetry);
    s.field("tilt_deg", o.tilt_deg);
    s.field("flip", o.flip);
    s.field("weights", o.weights);
    s.field("initial_poses", c.initial_poses);
    s.field("template", c.template_file);
    s.section("latent", [&](auto& latent) {
      latent.field("template", o.latent.template_kind);
      latent.field("noise", o.latent.noise);
      latent.field("matched_counts", o.latent.matched_counts);
      latent.field("localisations", o.latent.localisations);
      latent.field("visibility", o.latent.visibility);
      latent.field("outlier_fraction", o.latent.outlier_fraction);
      latent.field("regularisation", o.latent.regularisation);
      latent.field("regularisation_radius", o.latent.regularisation_radius);
      latent.field("medoids", o.latent.medoids);
      latent.field("basins", o.latent.basins);
      latent.field("rotations", o.latent.rotations);
      latent.field("most_loops", o.latent.most_loops);
      latent.field("escape_deg", o.latent.escape_deg);
    });
  });
  v.section("expert", [&](auto& s) { pipeline::engine_fields(s, c.registration.engine); });
  v.section("output", [&](auto& s) {
    s.field("directory", c.output.directory);
    s.field("formats", c.output.formats);
    s.field("voxel_nm", c.output.voxel_nm);
    s.field("preview", c.output.preview);
    s.field("frame", c.output.frame);
    s.field("labels_per_site", c.output.labels_per_site);
    s.field("report", c.output.report);
    s.field("resolution", c.output.resolution);
  });
}

void check_formats(const std::vector<std::string>& formats, std::vector<std::string>& faults) {
  std::vector<std::string> known = export_formats();
  known.insert(known.begin(), "hdf5");
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  for (auto format = formats.begin(); format != formats.end(); ++format) {
    if (std::find(known.begin(), known.end(), *format) == known.end())
      faults.push_back("output.formats holds '" + *format + "', expected one of " + list);
    if (std::find(formats.begin(), format, *format) != format)
      faults.push_back("output.formats holds '" + *format + "' twice");
  }
}

void check_input(const smlm::ReadOptions& options, std::vector<std::string>& faults) {
  for (const std::string& v : violations(options)) faults.push_back("input." + v);
}

void check_template(const RunConfig& c, std::vector<std::string>& faults) {
  const bool asked = wants(c.registration, "template");
  if (asked && c.template_file.empty())
    faults.emplace_back("registration.starts holds template: name its file as registration.template");
  if (!asked && !c.template_file.empty())
    faults.emplace_back("registration.template has no effect: add template to registration.starts");
  if (asked && c.registration.method != "likelihood")
    faults.emplace_back("registration.starts: template needs registration.method: likelihood");
  if (asked && !c.initial_poses.empty())
    faults.emplace_back(
        "registration.template has no effect beside registration.initial_poses: give one of them");
}

void check(const RunConfig& c, const std::string& path) {
  std::vector<std::string> faults;
  if (c.files.empty()) faults.emplace_back("input.files is missing: list the localisation tables");
  check_input(c.read, faults);
  for (const std::string& v : violations(c.registration)) faults.push_back(v);
  if (!c.initial_poses.empty() && c.registration.method != "likelihood")
    faults.emplace_back("registration.initial_poses needs registration.method: likelihood");
  check_template(c, faults);
  check_formats(c.output.formats, faults);
  if (c.output.resolution != "none" && c.output.resolution != "halves")
    faults.push_back("output.resolution is '" + c.output.resolution + "', expected none or halves");
  if (c.output.frame != "own" && c.output.frame != "raw")
    faults.push_back("output.frame is '" + c.output.frame + "', expected own or raw");
  if (c.output.labels_per_site < 1) faults.emplace_back("output.labels_per_site must be 1 or more");
  if (!(c.output.voxel_nm >= 0)) faults.emplace_back("output.voxel_nm must be 0 or more");
  if (c.output.directory.empty()) faults.emplace_back("output.directory is empty");
  smlm::throw_if_any(faults, smlm::Fault::usage, path);
}

// Puts what the tree says into `config`.
void read_fields(const pipeline::Node& root, const std::string& where, RunConfig& config) {
  pipeline::FieldReader reader(root, where);
  fields(reader, config);
  reader.finish();
}
}  // namespace

RunConfig pipeline::run_config_of(const Node& root, const std::string& where, const std::string& folder) {
  RunConfig config;
  read_fields(root, where, config);
  check(config, where);
  if (!config.read.pick.centres.empty())
    config.read.pick.centres = pipeline::resolve_path(config.read.pick.centres, folder);
  if (!config.registration.weights.empty())
    config.registration.weights = pipeline::resolve_path(config.registration.weights, folder);
  if (!config.initial_poses.empty())
    config.initial_poses = pipeline::resolve_path(config.initial_poses, folder);
  if (!config.template_file.empty())
    config.template_file = pipeline::resolve_path(config.template_file, folder);
  config.files = pipeline::expand_files(config.files, folder, &config.patterns);
  config.output.directory = pipeline::resolve_path(config.output.directory, folder);
  return config;
}

RunConfig load_run_config(const std::string& path, const std::vector<std::string>& overrides) {
  pipeline::Node root = pipeline::load_yaml(path);
  for (const std::string& assignment : overrides) pipeline::apply_override(root, assignment);
  return pipeline::run_config_of(root, path, pipeline::folder_of(path));
}

smlm::ReadOptions read_options(const std::vector<std::string>& overrides) {
  pipeline::Node nothing;
  nothing.kind = pipeline::Node::Kind::map;
  for (const std::string& assignment : overrides) pipeline::apply_override(nothing, assignment);
  RunConfig config;
  read_fields(nothing, "--set", config);
  std::vector<std::string> faults;
  if (!config.files.empty()) faults.emplace_back("input.files: the tables are named as arguments");
  check_input(config.read, faults);
  smlm::throw_if_any(faults, smlm::Fault::usage, "--set");
  return config.read;
}

std::string run_config_text(const RunConfig& config) {
  RunConfig copy = config;
  pipeline::FieldWriter writer;
  fields(writer, copy);
  return writer.text();
}

}  // namespace polar
