#include "model/encoder_step.hpp"

#include <cmath>

#include "model/gemm.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {
using kernel::kHidden1;
using kernel::kHidden2;
using kernel::kLatent;

struct XMoments {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double points = 0;
  XMoments& operator+=(const XMoments& o) {
    first += o.first, second += o.second, points += o.points;
    return *this;
  }
};

XMoments x_moments(const std::vector<Eigen::Matrix3Xf>& clouds) {
  return ordered_sum(clouds.size(), kCloudsPerBlock, XMoments{}, [&](std::size_t begin, std::size_t end) {
    XMoments m;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Matrix3Xd x = clouds[i].cast<double>();
      m += XMoments{x.rowwise().sum(), x * x.transpose(), static_cast<double>(x.cols())};
    }
    return m;
  });
}

struct HMoments {
  Eigen::VectorXd first = Eigen::VectorXd::Zero(kHidden1);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(kHidden1, kHidden1);
  HMoments& operator+=(const HMoments& o) {
    first += o.first, second += o.second;
    return *this;
  }
};

HMoments h_moments(const PackedEncoder& packed, const std::vector<Eigen::Matrix3Xf>& clouds) {
  return ordered_sum(clouds.size(), kCloudsPerBlock, HMoments{}, [&](std::size_t begin, std::size_t end) {
    HMoments sum;
    for (std::size_t i = begin; i < end; ++i) {
      RowMatrixXf gram = RowMatrixXf::Zero(kernel::kGramRows, kHidden1);
      Eigen::VectorXf first = Eigen::VectorXf::Zero(kHidden1);
      hidden1_blocks(packed.panels(), clouds[i].data(), clouds[i].cols(),
                     [&](Eigen::Index, int n, const float* h) {
                       kernel::active_table().gram(h, gram.data());
                       for (int p = 0; p < n; ++p)
                         first += Eigen::Map<const Eigen::VectorXf>(h + p * kHidden1, kHidden1);
                     });
      sum.first += first.cast<double>();
      sum.second += gram.topRows(kHidden1).cast<double>();
    }
    return sum;
  });
}

/// Moments of W u for u with this mean and second moment.
Moments linear_moments(const ConstMatrixMap& weight, const Eigen::VectorXd& mean,
                       const Eigen::MatrixXd& second) {
  const Eigen::MatrixXd w = weight.cast<double>();
  const Eigen::MatrixXd covariance = second - mean * mean.transpose();
  return {(w * mean).cast<float>(),
          (w * covariance).cwiseProduct(w).rowwise().sum().cwiseMax(0.0).cast<float>()};
}
}  // namespace

RowMatrixXf EncoderStep::forward(const std::vector<float>& parameters,
                                 const std::vector<Eigen::Matrix3Xf>& clouds) {
  const auto& layers = parameter_layout().encoder;
  const auto layer = [&](std::size_t i) {
    return fold(view(parameters, layers[i].weight), vector_view(parameters, layers[i].gain),
                vector_view(parameters, layers[i].shift), moments_[i]);
  };
  const XMoments x = x_moments(clouds);
  points_ = x.points;
  x_mean_ = x.first / points_;
  x_second_ = x.second / points_;
  moments_[0] = linear_moments(view(parameters, layers[0].weight), x_mean_, x_second_);
  std::array<Linear, 3> inference = {
      layer(0), Linear{RowMatrixXf::Zero(kHidden2, kHidden1), Eigen::VectorXf::Zero(kHidden2)},
      Linear{view(parameters, layers[2].weight), vector_view(parameters, layers[2].shift)}};
  const HMoments h = h_moments(PackedEncoder(inference), clouds);
  h_mean_ = h.first / points_;
  h_second_ = h.second / points_;
  moments_[1] = linear_moments(view(parameters, layers[1].weight), h_mean_, h_second_);
  inference[1] = layer(1);
  packed_ = PackedEncoder(inference);

  encoded_.resize(clouds.size());
  RowMatrixXf latent(static_cast<Eigen::Index>(clouds.size()), kLatent);
  parallel_for(clouds.size(), [&](std::size_t i) {
    encoded_[i] = packed_.encode(clouds[i]);
    latent.row(static_cast<Eigen::Index>(i)) = encoded_[i].latent.transpose();
  });
  return latent;
}

}  // namespace polar
