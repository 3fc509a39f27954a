#include "model/network_step.hpp"

#include "polar/core/parallel.hpp"
#include "polar/model/chamfer.hpp"

namespace polar {

double NetworkStep::loss(const std::vector<float>& parameters, const std::vector<TrainingCloud>& batch,
                         const DropoutKey& dropout, std::vector<float>& gradient) {
  std::vector<Eigen::Matrix3Xf> inputs;
  points_ = 0;
  clouds_ = static_cast<double>(batch.size());
  for (const TrainingCloud& cloud : batch) {
    inputs.push_back(cloud.input);
    points_ += static_cast<double>(cloud.input.cols());
  }
  const RowMatrixXf output = decoder_.forward(parameters, encoder_.forward(parameters, inputs), dropout);
  RowMatrixXf output_gradient(output.rows(), output.cols());
  std::vector<double> distance(batch.size());
  parallel_for(batch.size(), [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Matrix3Xf decoded =
        Eigen::Map<const Eigen::Matrix3Xf>(output.row(row).data(), 3, output.cols() / 3);
    Eigen::Matrix3Xf d;
    distance[i] = chamfer_gradient(decoded, batch[i].target, d).sum();
    output_gradient.row(row) =
        Eigen::Map<const Eigen::RowVectorXf>(d.data(), d.size()) / static_cast<float>(clouds_);
  });
  gradient.assign(parameters.size(), 0.0f);
  const RowMatrixXf latent_gradient = decoder_.backward(parameters, output_gradient, gradient);
  encoder_.backward(parameters, inputs, latent_gradient, gradient);
  double sum = 0;
  for (const double d : distance) sum += d;
  return sum / clouds_;
}

void NetworkStep::update(RunningMoments& running, double momentum) const {
  const auto move = [&](Moments& r, const Moments& now, double samples) {
    const float m = static_cast<float>(momentum), unbiased = static_cast<float>(samples / (samples - 1));
    r.mean += m * (now.mean - r.mean);
    r.variance += m * (unbiased * now.variance - r.variance);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    move(running[i], encoder_.moments(i), points_);
    move(running[2 + i], decoder_.moments(i), clouds_);
  }
}

}  // namespace polar
