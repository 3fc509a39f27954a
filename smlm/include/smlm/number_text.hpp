// How numbers are written wherever a person or another program reads them.
#pragma once

#include <string>

namespace smlm {

/// The shortest decimal text that reads back to the same double, in any locale; whole numbers up to 2^53 in
/// full ("100000", never "1e+05"). "nan" and "inf" where it is none.
std::string number_text(double value);

}  // namespace smlm
