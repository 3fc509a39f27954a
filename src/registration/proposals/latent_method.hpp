// method: latent, the paper's own end.
#pragma once

#include "../data/problem.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/registration/register.hpp"

namespace polar {

/// The latent optimum as a result: the decoded points are the template; likelihoods and margins are those of
/// the views under it, so that results of both methods can be compared.
Registration latent_method(const Problem& problem, const Autoencoder& model,
                           const RegistrationOptions& options, Progress& progress);

}  // namespace polar
