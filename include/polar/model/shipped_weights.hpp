// Where the autoencoder's weights lie.
#pragma once

#include <string>

namespace polar {

/// `configured` when it is not empty; else the weights that ship: beside an installed program
/// (../share/polar-smlm/weights), in the folder it was installed to, or in the source tree. Throws
/// smlm::Error (usage) where there is none.
std::string weights_path(const std::string& configured);

}  // namespace polar
