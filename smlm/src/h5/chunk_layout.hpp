// What a data set's header says of its chunks beyond what the library tells.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>

namespace smlm::h5 {

/// Bytes of one element by the layout message in the object header of `dataset` (HDF5 file format
/// specification, IV.A.1.a and IV.A.2.i), read from the file itself. HDF5 1.10 makes chunks in memory of this
/// size and does not compare it with the type, so a smaller one makes it read beyond them. 0: not chunked, or
/// a header of version 2, whose checksum the library verifies.
std::uint64_t chunk_element_bytes(const std::string& path, hid_t file, hid_t dataset);

}  // namespace smlm::h5
