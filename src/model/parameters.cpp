#include "model/parameters.hpp"

#include <cmath>

#include "polar/core/rng.hpp"

namespace polar {

namespace {
using kernel::kHidden1;
using kernel::kHidden2;
using kernel::kLatent;
constexpr std::uint32_t kStage = 0x77656967u;  // of the run's keyed random numbers
}  // namespace

ParameterLayout::ParameterLayout() {
  const auto take = [&](Eigen::Index rows, Eigen::Index columns) {
    const Segment s{size, rows, columns};
    size += s.size();
    return s;
  };
  const auto layer = [&](Eigen::Index out, Eigen::Index in, bool norm) {
    LayerSegments l;
    l.weight = take(out, in);
    if (norm) l.gain = take(out, 1);
    l.shift = take(out, 1);
    return l;
  };
  encoder = {layer(kHidden1, 3, true), layer(kHidden2, kHidden1, true), layer(kLatent, kHidden2, false)};
  decoder = {layer(kLatent, kLatent, true), layer(kLatent, kLatent, true),
             layer(Eigen::Index{3} * kLatent, kLatent, false)};
}

const ParameterLayout& parameter_layout() {
  static const ParameterLayout layout;
  return layout;
}

std::vector<float> initial_parameters(std::uint64_t seed) {
  const ParameterLayout& layout = parameter_layout();
  std::vector<float> parameters(layout.size, 0.0f);
  std::uint64_t item = 0;
  for (const auto* part : {&layout.encoder, &layout.decoder})
    for (const LayerSegments& layer : *part) {
      KeyedRandom random(seed, item++, kStage);
      const double bound = 1 / std::sqrt(static_cast<double>(layer.weight.columns));
      for (std::size_t i = 0; i < layer.weight.size(); ++i)
        parameters[layer.weight.begin + i] = static_cast<float>(bound * (2 * random.uniform() - 1));
      for (std::size_t i = 0; i < layer.gain.size(); ++i) parameters[layer.gain.begin + i] = 1;
    }
  return parameters;
}

RunningMoments initial_moments() {
  RunningMoments moments;
  const Eigen::Index channels[] = {kHidden1, kHidden2, kLatent, kLatent};
  for (std::size_t i = 0; i < moments.size(); ++i)
    moments[i] = {Eigen::VectorXf::Zero(channels[i]), Eigen::VectorXf::Ones(channels[i])};
  return moments;
}

Linear fold(const ConstMatrixMap& weight, const Eigen::Ref<const Eigen::VectorXf>& gain,
            const Eigen::Ref<const Eigen::VectorXf>& shift, const Moments& moments) {
  const Eigen::VectorXf scale = gain.array() / (moments.variance.array() + kNormEpsilon).sqrt();
  return {scale.asDiagonal() * weight, shift - scale.cwiseProduct(moments.mean)};
}

PointNetWeights folded(const std::vector<float>& parameters, const RunningMoments& moments) {
  const ParameterLayout& layout = parameter_layout();
  PointNetWeights weights;
  const auto convert = [&](const LayerSegments& s, const Moments* m) -> Linear {
    if (!m) return {view(parameters, s.weight), vector_view(parameters, s.shift)};
    return fold(view(parameters, s.weight), vector_view(parameters, s.gain), vector_view(parameters, s.shift),
                *m);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    weights.encoder[i] = convert(layout.encoder[i], i < 2 ? &moments[i] : nullptr);
    weights.decoder[i] = convert(layout.decoder[i], i < 2 ? &moments[2 + i] : nullptr);
  }
  return weights;
}

}  // namespace polar
