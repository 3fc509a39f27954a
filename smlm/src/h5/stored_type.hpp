// Whether a stored type is one that HDF5 can convert from.
#pragma once

#include <hdf5.h>

namespace smlm::h5 {

/// HDF5 1.10 believes what a damaged file says of its types, and converting from a field that reaches beyond
/// its record writes past the library's buffers, which does not always end the process. False for numbers
/// with more bits than bytes, fields beyond their record, and fields that lie on one another.
bool convertible(hid_t type);

}  // namespace smlm::h5
