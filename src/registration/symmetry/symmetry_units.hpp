// How evenly the symmetric units are labelled: registration turns the bright sites of symmetric particles
// onto one another, and the superparticle then has a hot spot that the structure has not.
#pragma once

#include "../data/problem.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// Names the units and counts the superparticle's localisations (of accepted views) in them.
void count_units(const Problem& problem, Registration& registration);

}  // namespace polar
