// The paper's registration (latent) on behalf of this layer: as a start among others and as a method of its
// own.
#pragma once

#include <memory>

#include "ab_initio.hpp"
#include "polar/core/progress.hpp"
#include "polar/latent/latent_registration.hpp"
#include "polar/registration/register.hpp"

namespace polar {

/// The autoencoder that `options` name. Throws smlm::Error where its file is missing or damaged.
std::unique_ptr<Autoencoder> autoencoder(const RegistrationOptions& options);

/// The hash that names those weights, empty where no autoencoder takes part.
std::string weights_sha256(const RegistrationOptions& options);

/// The latent options with the seed, search and optimizer of the registration.
LatentOptions latent_options(const RegistrationOptions& options);

/// A short latent registration of the views under competition: a constant number of encodings at most.
Hypothesis polar_start(const StartContext& context, const Autoencoder& model,
                       const RegistrationOptions& options, int centres, int number);

}  // namespace polar
