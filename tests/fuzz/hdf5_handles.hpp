// HDF5 on damaged files: its own leaks are known, ours are faults.
#pragma once

#include <hdf5.h>

#include <initializer_list>

// HDF5 1.10 loses memory of its own where it gives up on a damaged file: that is why such files are first
// read in another process. Whether we lose its handles is asked below.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

/// Handles of ours that are open; the library keeps some of its own types, which are not counted.
inline hsize_t open_handles() {
  hsize_t all = 0;
  for (const H5I_type_t type : {H5I_FILE, H5I_GROUP, H5I_DATASET, H5I_DATASPACE, H5I_ATTR}) {
    hsize_t count = 0;
    if (H5Inmembers(type, &count) >= 0) all += count;
  }
  return all;
}
