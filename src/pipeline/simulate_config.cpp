#include "config/fields.hpp"
#include "config/paths.hpp"
#include "polar/pipeline/simulate_run.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
template <class Visitor>
void fields(Visitor& v, SimulateConfig& c) {
  v.section("structure", [&](auto& s) {
    s.field("kind", c.structure.kind);
    s.field("radius_nm", c.structure.radius_nm);
    s.field("length_nm", c.structure.length_nm);
    s.field("units", c.structure.units);
    s.field("file", c.file.path);
    s.field("label", c.file.label);
    s.field("index", c.file.index);
  });
  v.section("simulation", [&](auto& s) {
    SimulationOptions& o = c.simulation;
    s.field("seed", o.seed);
    s.field("particles", o.particles);
    s.field("orientation", o.orientation);
    s.field("tilt_std_deg", o.tilt_std_deg);
    s.field("sampling", o.sampling);
    s.field("labelling_efficiency", o.labelling_efficiency);
    s.field("blinks_mean", o.blinks_mean);
    s.field("blinks", o.blinks);
    s.field("points", o.points);
    s.field("label_size_nm", o.label_size_nm);
    s.field("sigma_xy_nm", o.sigma_xy_nm);
    s.field("sigma_y_factor", o.sigma_y_factor);
    s.field("sigma_z_factor", o.sigma_z_factor);
    s.field("sigma_per", o.sigma_per);
    s.field("radius_std_nm", o.radius_std_nm);
    s.field("height_std_nm", o.height_std_nm);
    s.field("visibility", o.visibility);
    s.field("outlier_fraction", o.outlier_fraction);
    s.field("outliers", o.outliers);
    s.field("field_spacing_nm", o.field_spacing_nm);
    s.field("translation_nm", o.translation_nm);
    s.field("planar", o.planar);
    s.field("cramer_rao", o.cramer_rao);
  });
  v.section("output", [&](auto& s) {
    s.field("directory", c.directory);
    s.field("format", c.format);
  });
}

void check(const SimulateConfig& c, const std::string& path) {
  std::vector<std::string> faults;
  const bool from_file = c.structure.kind == "file";
  if (!from_file) faults = violations(c.structure);
  if (from_file && c.file.path.empty()) faults.emplace_back("structure.file is missing");
  if (!from_file && !c.file.path.empty()) faults.emplace_back("structure.file needs structure.kind: file");
  for (const std::string& fault : violations(c.simulation)) faults.push_back("simulation." + fault);
  if (c.format != "csv" && c.format != "picasso")
    faults.push_back("output.format is '" + c.format + "', expected csv or picasso");
  smlm::throw_if_any(faults, smlm::Fault::usage, path);
}
}  // namespace

SimulateConfig load_simulate_config(const std::string& path, const std::vector<std::string>& overrides) {
  pipeline::Node root = pipeline::load_yaml(path);
  for (const std::string& assignment : overrides) pipeline::apply_override(root, assignment);
  SimulateConfig config;
  pipeline::FieldReader reader(root, path);
  fields(reader, config);
  reader.finish();
  const std::string folder = pipeline::folder_of(path);
  config.directory = pipeline::resolve_path(config.directory, folder);
  if (!config.file.path.empty()) config.file.path = pipeline::resolve_path(config.file.path, folder);
  config.file.radius_nm = config.structure.radius_nm;
  check(config, path);
  return config;
}

std::string simulate_config_text(const SimulateConfig& config) {
  SimulateConfig copy = config;
  pipeline::FieldWriter writer;
  fields(writer, copy);
  return writer.text();
}

}  // namespace polar
