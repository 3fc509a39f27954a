#include "polar_start.hpp"

#include <algorithm>

#include "polar/model/shipped_weights.hpp"
#include "polar/model/weights_file.hpp"
#include "smlm/isolation.hpp"

namespace polar {

namespace {

// A start is judged and refined by the likelihood, so it only has to find the basins.
constexpr int kLocalisations = 256, kRotations = 1152, kBasins = 4, kLoopsAlone = 2;

Views chosen(const Problem& problem, const std::vector<int>& which) {
  Views few;
  few.planar = problem.planar();
  for (const int i : which) few.view.push_back(problem.views.view[static_cast<std::size_t>(i)]);
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

std::vector<SoftPose> polar_poses(const Problem& problem, const std::vector<int>& which,
                                  const Autoencoder& model, const RegistrationOptions& options) {
  LatentOptions few = latent_options(options);
  few.localisations = std::min(few.localisations, kLocalisations);
  few.basins = std::min(few.basins, kBasins);
  few.most_loops = std::min(few.most_loops, options.starts.size() > 1 ? 1 : kLoopsAlone);
  if (few.rotations == 0 && few.search == "fast" && !problem.planar()) few.rotations = kRotations;
  Progress silent;
  const LatentRegistration latent = register_latent(chosen(problem, which), model, few, silent);
  std::vector<SoftPose> pose(problem.size());
  for (std::size_t k = 0; k < which.size() && k < latent.view.size(); ++k) {
    const Pose& p = latent.view[k].template_from_view;
    pose[static_cast<std::size_t>(which[k])] = {p.rotation.cast<float>(), p.translation.cast<float>()};
  }
  return pose;
}

}  // namespace polar
