// How tables say "nothing": one notion for numbers and for particles.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace smlm {

/// Empty, nan in any spelling (also -nan(ind), 1.#IND, #QNAN), NA, N/A, None, null, #N/A and the like.
bool is_missing(std::string_view text);

/// Whether a particle's id stands for no particle: missing, a negative number, or one of `stated`.
bool names_no_particle(std::string_view id, const std::vector<std::string>& stated);

}  // namespace smlm
