#include "polar/model/train_options.hpp"

namespace polar {

std::vector<std::string> violations(const TrainOptions& o) {
  std::vector<std::string> faults;
  const auto need = [&](bool holds, const char* sentence) {
    if (!holds) faults.emplace_back(sentence);
  };
  const auto share = [&](double value, const char* key) {
    if (!(value >= 0 && value <= 1)) faults.push_back(std::string(key) + " must be between 0 and 1");
  };
  share(o.data.procedural_share, "data.procedural_share");
  share(o.data.stretch_share, "data.stretch_share");
  share(o.data.sites_share, "data.sites_share");
  share(o.data.grid_share, "data.grid_share");
  const Degradation& d = o.degradation;
  share(d.full_share, "degradation.full_share");
  share(d.clean_share, "degradation.clean_share");
  share(d.anisotropic_share, "degradation.anisotropic_share");
  share(d.per_point_share, "degradation.per_point_share");
  share(d.uneven_share, "degradation.uneven_share");
  share(d.cut_share, "degradation.cut_share");
  share(d.recentre_share, "degradation.recentre_share");
  share(d.rescale_share, "degradation.rescale_share");
  share(d.few_labels_share, "degradation.few_labels_share");
  need(d.min_labels >= 1 && d.min_labels <= d.max_labels && d.max_labels <= 1024,
       "degradation.min_labels must be at least 1 and at most degradation.max_labels, which is at most 1024");
  need(d.min_points >= 1 && d.min_points <= d.max_points,
       "degradation.min_points must be at least 1 and at most degradation.max_points");
  need(d.max_points <= 1024, "degradation.max_points must be at most 1024, the size of a clean cloud");
  need(d.max_sigma >= 0.005 && d.max_sigma <= 1, "degradation.max_sigma must be between 0.005 and 1");
  need(d.min_visibility > 0 && d.min_visibility <= 1, "degradation.min_visibility must be in (0, 1]");
  need(o.clouds_per_step >= 2 && o.clouds_per_step <= 4096, "clouds_per_step must be between 2 and 4096");
  need(o.steps >= 1 && o.steps <= 1000000000, "steps must be between 1 and 1000000000");
  need(o.learning_rate > 0 && o.learning_rate <= 1, "learning_rate must be in (0, 1]");
  need(o.schedule == "cosine" || o.schedule == "plateau", "schedule must be cosine or plateau");
  need(o.warmup_steps >= 0, "warmup_steps must not be negative");
  need(o.plateau_patience >= 1, "plateau_patience must be at least 1");
  need(o.weight_decay >= 0 && o.weight_decay < 1, "weight_decay must be in [0, 1)");
  need(o.dropout >= 0 && o.dropout < 1, "dropout must be in [0, 1)");
  need(o.batch_norm_momentum > 0 && o.batch_norm_momentum <= 1, "batch_norm_momentum must be in (0, 1]");
  need(o.report_every_steps >= 1, "report_every_steps must be at least 1");
  need(o.checkpoint_every_steps >= 1, "checkpoint_every_steps must be at least 1");
  need(!o.weights.empty(), "weights must name the file to write");
  return faults;
}

}  // namespace polar
