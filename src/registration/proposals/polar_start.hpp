// The paper's registration (latent) on behalf of this layer: as a start among others and as a method of its
// own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "../anneal/soft_poses.hpp"
#include "polar/core/progress.hpp"
#include "polar/latent/latent_registration.hpp"
#include "polar/registration/register.hpp"

namespace polar {

/// The autoencoder that takes part and the hash that names its weights; both empty where none does.
struct LatentModel {
  std::unique_ptr<Autoencoder> autoencoder;
  std::string weights_sha256;
};

/// Throws smlm::Error where the file that `options` need is missing or damaged.
LatentModel latent_model(const RegistrationOptions& options);

/// The latent options with the seed, search and optimizer of the registration.
LatentOptions latent_options(const RegistrationOptions& options);

/// A short latent registration of the views `which`: their poses, identity for the others.
std::vector<SoftPose> polar_poses(const Problem& problem, const std::vector<int>& which,
                                  const Autoencoder& model, const RegistrationOptions& options);

}  // namespace polar
