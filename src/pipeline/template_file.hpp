// `registration.template`: the file of a structure that is known beforehand.
#pragma once

#include <string>

#include "polar/registration/register.hpp"

namespace polar::pipeline {

/// An earlier results.h5 gives its fused template with the weights of its centres; any other file is read as
/// a structure of polar simulate is (sites.csv, a table of x, y, z, .ply), every site alike. Throws
/// smlm::Error (input).
KnownTemplate read_template(const std::string& path);

}  // namespace polar::pipeline
