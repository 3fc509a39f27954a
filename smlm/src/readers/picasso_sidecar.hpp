// The .yaml file that Picasso keeps beside each .hdf5 file.
#pragma once

#include <optional>
#include <string>

namespace smlm::readers {

/// The sidecar of "a/b.hdf5" is "a/b.yaml".
std::string picasso_sidecar_path(const std::string& hdf5_path);

/// Nanometres per camera pixel: the last document with a `Pixelsize` that is neither 0 nor empty decides, as
/// in Picasso. Only top-level keys of block style count, which is all that Picasso and SMAP write; reading
/// lines instead of YAML means that nothing in a sidecar can nest, loop or expand. Nothing when the file is
/// absent or holds none; Error(input) when it is no text.
std::optional<double> picasso_pixel_size_nm(const std::string& sidecar_path);

}  // namespace smlm::readers
