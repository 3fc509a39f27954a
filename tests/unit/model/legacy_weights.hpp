// Reads the development weights of ../shared/data/weights (layout in its README) into our form: their batch
// norms follow biased layers, and a plain 64 x 64 layer precedes the encoder's second one.
#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/half.hpp"
#include "model/parameters.hpp"

namespace polar {

inline PointNetWeights read_legacy_weights(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  std::size_t at = 0;
  const auto take = [&](Eigen::Index n) {
    Eigen::VectorXf v(n);
    for (Eigen::Index i = 0; i < n; ++i, at += 2) {
      const auto low = static_cast<unsigned char>(bytes.at(at)),
                 high = static_cast<unsigned char>(bytes.at(at + 1));
      v[i] = float_from_half(static_cast<std::uint16_t>(low | high << 8));
    }
    return v;
  };
  const auto linear = [&](Eigen::Index out, Eigen::Index in) {
    const Eigen::VectorXf w = take(out * in);
    return Linear{ConstMatrixMap(w.data(), out, in), take(out)};
  };
  std::vector<Linear> l;
  const Eigen::Index shapes[][2] = {{64, 3},      {64, 64},     {128, 64},   {1024, 128},
                                    {1024, 1024}, {1024, 1024}, {3072, 1024}};
  for (const auto& s : shapes) l.push_back(linear(s[0], s[1]));
  const std::size_t normed[] = {0, 2, 4, 5};
  std::vector<Eigen::VectorXf> scale, shift;
  for (const std::size_t i : normed) {
    scale.push_back(take(l[i].bias.size()));
    shift.push_back(take(l[i].bias.size()));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    Linear& layer = l[normed[k]];
    const Eigen::VectorXf mean = take(layer.bias.size()), variance = take(layer.bias.size());
    const Eigen::VectorXf factor = scale[k].array() / (variance.array() + kNormEpsilon).sqrt();
    layer.bias = (factor.cwiseProduct(layer.bias - mean) + shift[k]).eval();
    layer.weight = (factor.asDiagonal() * layer.weight).eval();
  }
  if (at != bytes.size()) throw std::runtime_error(path + ": not the expected size");
  const Linear second{l[2].weight * l[1].weight, l[2].weight * l[1].bias + l[2].bias};
  return {{l[0], second, l[3]}, {l[4], l[5], l[6]}};
}

}  // namespace polar
