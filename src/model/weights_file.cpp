#include "polar/model/weights_file.hpp"

#include <cstdint>
#include <vector>

#include "model/half.hpp"
#include "polar/core/sha256.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace polar {

namespace {
constexpr const char* kFormat = "polar autoencoder";
constexpr std::int32_t kVersion = 1;
constexpr int kGzip = 6;

/// body(group, layer) for the six layers in file order.
template <typename Weights, typename Body>
void each_layer(Weights& weights, Body body) {
  for (std::size_t i = 0; i < 3; ++i) body("/encoder/" + std::to_string(i), weights.encoder[i]);
  for (std::size_t i = 0; i < 3; ++i) body("/decoder/" + std::to_string(i), weights.decoder[i]);
}

std::string hash(const PointNetWeights& weights) {
  std::vector<unsigned char> bytes;
  const auto append = [&](const float* values, Eigen::Index n) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto bits = Eigen::numext::bit_cast<std::uint32_t>(values[i]);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(bits >> shift));
    }
  };
  each_layer(weights, [&](const std::string&, const Linear& layer) {
    append(layer.weight.data(), layer.weight.size());
    append(layer.bias.data(), layer.bias.size());
  });
  return sha256(bytes.data(), bytes.size());
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw smlm::Error(smlm::Fault::input, path, what, "use a file written by `polar train`");
}

std::vector<float> read_numbers(const smlm::h5::File& h5, const std::string& object, bool half) {
  if (!half) return h5.read<float>(object);
  const auto patterns = h5.read<std::uint16_t>(object);
  std::vector<float> values(patterns.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float_from_half(patterns[i]);
  return values;
}
}  // namespace

WeightsFile read_weights(const std::string& path) {
  const smlm::h5::File h5 = smlm::h5::File::open(path);
  for (const char* name : {"format", "version", "precision", "sha256", "about"})
    if (!h5.has_attribute("/", name))
      refuse(path, std::string("is no weights file: attribute `") + name + "` is missing");
  if (h5.read_string_attribute("/", "format") != kFormat) refuse(path, "is no weights file of this program");
  const auto version = h5.read_attribute<std::int32_t>("/", "version");
  if (version.size() != 1 || version[0] != kVersion)
    refuse(path, "has version " + (version.empty() ? std::string("none") : std::to_string(version[0])) +
                     ", this program reads version " + std::to_string(kVersion));
  const std::string precision = h5.read_string_attribute("/", "precision");
  if (precision != "half" && precision != "single")
    refuse(path, "has the unknown precision `" + precision + "`");

  WeightsFile file;
  each_layer(file.weights, [&](const std::string& group, Linear& layer) {
    const auto shape = h5.info(group + "/weight").shape;
    if (shape.size() != 2) refuse(path, group + "/weight is no matrix");
    const auto weight = read_numbers(h5, group + "/weight", precision == "half");
    const auto bias = read_numbers(h5, group + "/bias", precision == "half");
    layer.weight = Eigen::Map<const RowMatrixXf>(weight.data(), static_cast<Eigen::Index>(shape[0]),
                                                 static_cast<Eigen::Index>(shape[1]));
    layer.bias = Eigen::Map<const Eigen::VectorXf>(bias.data(), static_cast<Eigen::Index>(bias.size()));
  });
  file.sha256 = hash(file.weights);
  if (file.sha256 != h5.read_string_attribute("/", "sha256"))
    refuse(path, "is damaged: its numbers do not have the hash that it states");
  require_network(file.weights, path);
  file.about = h5.read_string_attribute("/", "about");
  return file;
}

std::string write_weights(const std::string& path, const PointNetWeights& weights, Precision precision,
                          const std::string& about) {
  PointNetWeights stored = weights;
  if (precision == Precision::half)
    each_layer(stored, [](const std::string&, Linear& layer) {
      const auto round = [](float v) { return float_from_half(half_from_float(v)); };
      layer.weight = layer.weight.unaryExpr(round).eval();
      layer.bias = layer.bias.unaryExpr(round).eval();
    });
  std::string name = hash(stored);
  smlm::AtomicFile file(path);
  smlm::h5::File h5 = smlm::h5::File::create(file.temporary_path());
  const auto write = [&](const std::string& object, const float* values, const smlm::h5::Shape& shape) {
    std::uint64_t n = 1;
    for (const std::uint64_t s : shape) n *= s;
    const std::vector<float> numbers(values, values + n);
    if (precision == Precision::single) {
      h5.write(object, numbers, shape, {kGzip, {}});
      return;
    }
    std::vector<std::uint16_t> patterns;
    patterns.reserve(numbers.size());
    for (const float v : numbers) patterns.push_back(half_from_float(v));
    h5.write(object, patterns, shape, {kGzip, {}});
    h5.write_string_attribute(object, "encoding", "IEEE 754 binary16");
  };
  each_layer(stored, [&](const std::string& group, const Linear& layer) {
    write(group + "/weight", layer.weight.data(),
          {static_cast<std::uint64_t>(layer.weight.rows()), static_cast<std::uint64_t>(layer.weight.cols())});
    write(group + "/bias", layer.bias.data(), {static_cast<std::uint64_t>(layer.bias.size())});
  });
  h5.write_string_attribute("/", "format", kFormat);
  h5.write_attribute("/", "version", kVersion);
  h5.write_string_attribute("/", "precision", precision == Precision::half ? "half" : "single");
  h5.write_string_attribute("/", "sha256", name);
  h5.write_string_attribute("/", "about", about);
  h5.close();
  file.commit();
  return name;
}

}  // namespace polar
