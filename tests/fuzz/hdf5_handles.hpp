// HDF5 on damaged files: its own leaks are known, ours are faults.
#pragma once

#include <hdf5.h>

// HDF5 1.10 loses memory of its own where it gives up on a damaged file: that is why such files are first
// read in another process. Whether we lose its handles is asked below.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

/// Files that are open, and whatever is open in them.
inline ssize_t open_handles() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library's own words would fill the log
  return H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL);
}
