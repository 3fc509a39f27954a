// Round lengths for scale bars.
#pragma once

#include <string>

namespace polar::results {

/// The largest of 1, 2, 5 x 10^k that is not longer than `most`.
double round_length(double most);

/// "50 nm", "2 um".
std::string length_label(double nm);

}  // namespace polar::results
