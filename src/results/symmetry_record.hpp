// /symmetry of results.h5.
#pragma once

#include "polar/registration/symmetry.hpp"
#include "smlm/h5/file.hpp"

namespace polar {

void write_symmetry(smlm::h5::File& file, const Symmetry& symmetry, double scale_nm);

}  // namespace polar
