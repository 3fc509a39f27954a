// Weights of the autoencoder as a file: HDF5 that holds numbers and text, never code.
//
// /encoder/0 ... /decoder/2, each with `weight` (out x in) and `bias`, 32-bit floats or IEEE half precision
// stored as 16-bit patterns; root attributes `format` (polar autoencoder), `version`, `precision`, `sha256`
// (of all numbers in file order as little-endian 32-bit floats) and `about` (how they were trained).
#pragma once

#include <string>

#include "polar/model/pointnet.hpp"

namespace polar {

enum class Precision { single, half };

struct WeightsFile {
  PointNetWeights weights;
  std::string sha256;  // 64 hexadecimal digits, also what results record
  std::string about;
};

/// Throws smlm::Error (input) where the file is no weights file, of a later version, or its hash is wrong.
WeightsFile read_weights(const std::string& path);

/// Atomic. Returns the hash that was written; with half precision that of the rounded weights.
std::string write_weights(const std::string& path, const PointNetWeights& weights, Precision precision,
                          const std::string& about);

}  // namespace polar
