// Registration under a fused template: one view's localisations are the first template, and the views that
// fit best extend it, until no view moves.
#pragma once

#include "polar/latent/latent_registration.hpp"

namespace polar {

LatentRegistration grow(const Views& views, const Autoencoder& model, const LatentOptions& options,
                        Progress& progress);

}  // namespace polar
