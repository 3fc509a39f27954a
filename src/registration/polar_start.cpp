#include "polar_start.hpp"

#include <algorithm>

#include "polar/model/shipped_weights.hpp"
#include "polar/model/weights_file.hpp"
#include "smlm/isolation.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

// A start is judged and refined by the likelihood, so it only has to find the basins.
constexpr int kLocalisations = 256, kRotations = 1152, kBasins = 4, kLoopsAlone = 2;

Views chosen(const StartContext& context) {
  Views few;
  few.planar = context.problem.planar();
  for (const int i : context.which)
    few.view.push_back(context.problem.views.view[static_cast<std::size_t>(i)]);
  return few;
}

WeightsFile weights_of(const RegistrationOptions& options) {
  const std::string path = weights_path(options.weights);
  if (options.weights.empty()) return read_weights(path);  // those that ship are no stranger's
  return smlm::read_isolated(path, [&] { return read_weights(path); });
}

}  // namespace

LatentModel latent_model(const RegistrationOptions& options) {
  if (!needs_weights(options)) return {};
  WeightsFile file = weights_of(options);
  return {make_pointnet(file.weights), std::move(file.sha256)};
}

LatentOptions latent_options(const RegistrationOptions& options) {
  LatentOptions latent = options.latent;
  latent.seed = options.seed;
  latent.search = options.search;
  latent.optimizer = options.optimizer;
  return latent;
}

Hypothesis polar_start(const StartContext& context, const Autoencoder& model,
                       const RegistrationOptions& options, int centres, int number) {
  LatentOptions few = latent_options(options);
  few.localisations = std::min(few.localisations, kLocalisations);
  few.basins = std::min(few.basins, kBasins);
  few.most_loops = std::min(few.most_loops, options.starts.size() > 1 ? 1 : kLoopsAlone);
  if (few.rotations == 0 && few.search == "fast" && !context.problem.planar()) few.rotations = kRotations;
  Progress silent;
  const LatentRegistration latent = register_latent(chosen(context), model, few, silent);
  Hypothesis h;
  h.name = "polar";
  h.number = number;
  for (const LatentPose& p : latent.view) h.pose.push_back(p.template_from_view);
  return with_template(context, centres, std::move(h));
}

}  // namespace polar
