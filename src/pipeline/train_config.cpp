#include "polar/pipeline/train_config.hpp"

#include "config/fields.hpp"
#include "config/paths.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
template <class Visitor>
void fields(Visitor& v, TrainOptions& o) {
  v.section("data", [&](auto& s) {
    s.field("shapes", o.data.shapes);
    s.field("procedural_share", o.data.procedural_share);
    s.field("stretch_share", o.data.stretch_share);
    s.field("sites_share", o.data.sites_share);
    s.field("grid_share", o.data.grid_share);
  });
  v.section("degradation", [&](auto& s) {
    Degradation& d = o.degradation;
    s.field("min_points", d.min_points);
    s.field("max_points", d.max_points);
    s.field("full_share", d.full_share);
    s.field("clean_share", d.clean_share);
    s.field("max_sigma", d.max_sigma);
    s.field("anisotropic_share", d.anisotropic_share);
    s.field("per_point_share", d.per_point_share);
    s.field("uneven_share", d.uneven_share);
    s.field("cut_share", d.cut_share);
    s.field("min_visibility", d.min_visibility);
    s.field("recentre_share", d.recentre_share);
    s.field("rescale_share", d.rescale_share);
    s.field("few_labels_share", d.few_labels_share);
    s.field("min_labels", d.min_labels);
    s.field("max_labels", d.max_labels);
  });
  v.section("training", [&](auto& s) {
    s.field("seed", o.seed);
    s.field("clouds_per_step", o.clouds_per_step);
    s.field("steps", o.steps);
    s.field("learning_rate", o.learning_rate);
    s.field("schedule", o.schedule);
    s.field("warmup_steps", o.warmup_steps);
    s.field("plateau_patience", o.plateau_patience);
    s.field("weight_decay", o.weight_decay);
    s.field("dropout", o.dropout);
    s.field("batch_norm_momentum", o.batch_norm_momentum);
    s.field("initial_weights", o.initial_weights);
  });
  v.section("output", [&](auto& s) {
    s.field("weights", o.weights);
    s.field("checkpoint", o.checkpoint);
    s.field("checkpoint_every_steps", o.checkpoint_every_steps);
    s.field("report_every_steps", o.report_every_steps);
  });
  v.section("score", [&](auto& s) { s.field("shapes", o.score_shapes); });
}
}  // namespace

TrainOptions load_train_options(const std::string& path, const std::vector<std::string>& overrides) {
  pipeline::Node root = pipeline::load_yaml(path);
  for (const std::string& assignment : overrides) pipeline::apply_override(root, assignment);
  TrainOptions options;
  pipeline::FieldReader reader(root, path);
  fields(reader, options);
  reader.finish();
  smlm::throw_if_any(violations(options), smlm::Fault::usage, path);
  const std::string folder = pipeline::folder_of(path);
  options.data.shapes = pipeline::expand_files(options.data.shapes, folder);
  options.score_shapes = pipeline::expand_files(options.score_shapes, folder);
  options.weights = pipeline::resolve_path(options.weights, folder);
  if (!options.initial_weights.empty())
    options.initial_weights = pipeline::resolve_path(options.initial_weights, folder);
  if (!options.checkpoint.empty()) options.checkpoint = pipeline::resolve_path(options.checkpoint, folder);
  return options;
}

std::string train_options_text(const TrainOptions& options) {
  TrainOptions copy = options;
  pipeline::FieldWriter writer;
  fields(writer, copy);
  return writer.text();
}

}  // namespace polar
