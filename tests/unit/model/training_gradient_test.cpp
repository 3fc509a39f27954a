// The trainer's derivatives against central differences, one segment of the parameters at a time. The loss is
// computed in single precision, so the differences are taken along the gradient, where they are largest, and
// along a random direction.
#include <gtest/gtest.h>

#include <cmath>

#include "model/network_step.hpp"

namespace polar {
namespace {

// Single precision leaves the difference quotient some 3 digits; a wrong term is off by tens of per cent.
constexpr double kRelativeTolerance = 0.02;

std::vector<TrainingCloud> small_batch(int clouds) {
  Degradation degradation;
  degradation.max_points = 300;
  std::vector<TrainingCloud> batch;
  for (int i = 0; i < clouds; ++i)
    batch.push_back(training_cloud(3, static_cast<std::uint64_t>(i), TrainData{}, ShapeSet{}, degradation));
  return batch;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return sum;
}

/// Direction of unit length in one segment: along the gradient, or random.
std::vector<float> direction(const Segment& s, const std::vector<float>& gradient, bool random_one) {
  std::vector<float> d(gradient.size(), 0.0f);
  KeyedRandom random(11, s.begin, 0);
  double norm = 0;
  for (std::size_t i = s.begin; i < s.begin + s.size(); ++i) {
    d[i] = random_one ? gradient[i] * static_cast<float>(2 * random.uniform()) : gradient[i];
    norm += static_cast<double>(d[i]) * static_cast<double>(d[i]);
  }
  for (float& v : d) v /= static_cast<float>(std::sqrt(norm));
  return d;
}

template <typename Loss>
void check_segment(const char* name, const Segment& s, const std::vector<float>& parameters,
                   const std::vector<float>& gradient, double step, Loss loss) {
  for (const bool random_one : {false, true}) {
    const std::vector<float> d = direction(s, gradient, random_one);
    const auto at = [&](double t) {
      std::vector<float> moved = parameters;
      for (std::size_t i = s.begin; i < s.begin + s.size(); ++i) moved[i] += static_cast<float>(t) * d[i];
      return loss(moved);
    };
    const double numeric = (at(step) - at(-step)) / (2 * step), analytic = dot(gradient, d);
    EXPECT_NEAR(numeric, analytic, kRelativeTolerance * std::abs(analytic)) << name;
    EXPECT_GT(std::abs(analytic), 0) << name;
  }
}

std::vector<float> test_parameters() {
  std::vector<float> parameters = initial_parameters(5);
  // Gains and shifts away from 1 and 0, so that no term vanishes by chance.
  KeyedRandom random(6, 0, 0);
  for (const auto* part : {&parameter_layout().encoder, &parameter_layout().decoder})
    for (const LayerSegments& layer : *part)
      for (const Segment& s : {layer.gain, layer.shift})
        for (std::size_t i = 0; i < s.size(); ++i)
          parameters[s.begin + i] += static_cast<float>(0.2 * random.normal());
  return parameters;
}

TEST(EncoderStep, gradientMatchesCentralDifferences) {
  const auto batch = small_batch(5);
  std::vector<Eigen::Matrix3Xf> clouds;
  for (const TrainingCloud& c : batch) clouds.push_back(c.input);
  const std::vector<float> parameters = test_parameters();
  RowMatrixXf weight = RowMatrixXf::Zero(5, kernel::kLatent);
  KeyedRandom random(7, 0, 0);
  for (Eigen::Index i = 0; i < weight.size(); ++i) weight.data()[i] = static_cast<float>(random.normal());
  // Quadratic in z as well, so that the weights of the sum depend on the forward pass.
  const auto loss = [&](const std::vector<float>& p) {
    EncoderStep step;
    const Eigen::MatrixXd z = step.forward(p, clouds).cast<double>();
    return (weight.cast<double>().cwiseProduct(z) + 0.5 * z.cwiseProduct(z)).sum();
  };
  EncoderStep step;
  const RowMatrixXf z = step.forward(parameters, clouds);
  std::vector<float> gradient(parameters.size(), 0.0f);
  step.backward(parameters, clouds, weight + z, gradient);
  const auto& layers = parameter_layout().encoder;
  check_segment("weight 0", layers[0].weight, parameters, gradient, 1e-3, loss);
  check_segment("gain 0", layers[0].gain, parameters, gradient, 1e-3, loss);
  check_segment("shift 0", layers[0].shift, parameters, gradient, 1e-3, loss);
  check_segment("weight 1", layers[1].weight, parameters, gradient, 1e-3, loss);
  check_segment("gain 1", layers[1].gain, parameters, gradient, 1e-3, loss);
  check_segment("shift 1", layers[1].shift, parameters, gradient, 1e-3, loss);
  check_segment("weight 2", layers[2].weight, parameters, gradient, 1e-2, loss);
  check_segment("bias 2", layers[2].shift, parameters, gradient, 1e-2, loss);
}

TEST(NetworkStep, gradientMatchesCentralDifferences) {
  const auto batch = small_batch(6);
  const std::vector<float> parameters = test_parameters();
  const DropoutKey dropout{1, 0, 0.1};
  std::vector<float> ignored, gradient;
  const auto loss = [&](const std::vector<float>& p) {
    return NetworkStep().loss(p, batch, dropout, ignored);
  };
  const double value = NetworkStep().loss(parameters, batch, dropout, gradient);
  EXPECT_GT(value, 0);
  const auto check = [&](const char* name, const Segment& s) {
    check_segment(name, s, parameters, gradient, 5e-4, loss);
  };
  const auto& layout = parameter_layout();
  check("encoder weight 1", layout.encoder[1].weight);
  check("encoder weight 2", layout.encoder[2].weight);
  for (const LayerSegments& layer : layout.decoder) {
    check("decoder weight", layer.weight);
    check("decoder shift", layer.shift);
    if (layer.gain.size() > 0) check("decoder gain", layer.gain);
  }
}

}  // namespace
}  // namespace polar
