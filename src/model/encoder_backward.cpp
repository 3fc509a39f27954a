#include <algorithm>

#include "model/encoder_step.hpp"
#include "model/gemm.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {
using kernel::kHidden1;
using kernel::kHidden2;
using kernel::kLatent;

Eigen::VectorXf inverse_deviation(const Moments& m) { return (m.variance.array() + kNormEpsilon).rsqrt(); }
}  // namespace

/// What the critical points contribute.
struct EncoderStep::Sparse {
  RowMatrixXf weight3 = RowMatrixXf::Zero(kLatent, kHidden2);
  Eigen::VectorXf bias3 = Eigen::VectorXf::Zero(kLatent);
  RowMatrixXf weight2 = RowMatrixXf::Zero(kHidden2, kHidden1);  // sum of dy2 h1^T
  Eigen::VectorXf shift2 = Eigen::VectorXf::Zero(kHidden2);     // sum of dy2
  Eigen::VectorXf gain2 = Eigen::VectorXf::Zero(kHidden2);      // sum of dy2 * normalised input of norm 2
  RowMatrixXf first = RowMatrixXf::Zero(4, kHidden1);           // sum of dy1 times (1, x, y, z)
  Sparse& operator+=(const Sparse& o) {
    weight3 += o.weight3, bias3 += o.bias3, weight2 += o.weight2, shift2 += o.shift2, gain2 += o.gain2;
    first += o.first;
    return *this;
  }
};

EncoderStep::Sparse EncoderStep::critical_pass(const std::vector<float>& parameters,
                                               const std::vector<Eigen::Matrix3Xf>& clouds,
                                               const RowMatrixXf& latent_gradient) const {
  const auto& layers = parameter_layout().encoder;
  const ConstMatrixMap w2 = view(parameters, layers[1].weight), w3 = view(parameters, layers[2].weight);
  const auto gain = vector_view(parameters, layers[1].gain), shift = vector_view(parameters, layers[1].shift);
  const Eigen::VectorXf inverse = inverse_deviation(moments_[1]);
  const RowMatrixXf scaled_w2 = gain.cwiseProduct(inverse).asDiagonal() * w2;

  const auto one = [&](std::size_t i, Sparse& sum) {
    const Eigen::VectorXi& critical = encoded_[i].critical;
    std::vector<Eigen::Index> row(static_cast<std::size_t>(clouds[i].cols()), -1), point;
    for (const int p : critical)
      if (row[static_cast<std::size_t>(p)] < 0) {
        row[static_cast<std::size_t>(p)] = static_cast<Eigen::Index>(point.size());
        point.push_back(p);
      }
    const int n = static_cast<int>(point.size());
    Eigen::Matrix3Xf x(3, n);
    for (Eigen::Index p = 0; p < n; ++p) x.col(p) = clouds[i].col(point[static_cast<std::size_t>(p)]);
    RowMatrixXf h1(n, kHidden1), normal2(n, kHidden2);
    hidden1_blocks(packed_.panels(), x.data(), n, [&](Eigen::Index first, int count, const float* h) {
      h1.middleRows(first, count) = ConstMatrixMap(h, count, kHidden1);
    });
    gemm(n, kHidden2, kHidden1, row_major(h1.data(), kHidden1), transposed(row_major(w2.data(), kHidden1)),
         normal2.data(), kHidden2, false, Threads::serial);
    for (Eigen::Index p = 0; p < n; ++p)
      normal2.row(p) = (normal2.row(p) - moments_[1].mean.transpose()).cwiseProduct(inverse.transpose());

    RowMatrixXf dy2 = RowMatrixXf::Zero(n, kHidden2), h2(n, kHidden2);
    for (Eigen::Index p = 0; p < n; ++p)
      h2.row(p) = (normal2.row(p).cwiseProduct(gain.transpose()) + shift.transpose()).cwiseMax(0.0f);
    for (Eigen::Index c = 0; c < kLatent; ++c) {
      const Eigen::Index p = row[static_cast<std::size_t>(critical[c])];
      const float g = latent_gradient(static_cast<Eigen::Index>(i), c);
      sum.bias3[c] += g;
      sum.weight3.row(c) += g * h2.row(p);
      dy2.row(p) += g * w3.row(c);
    }
    dy2 = (h2.array() > 0.0f).select(dy2, 0.0f);
    for (Eigen::Index p = 0; p < n; ++p) {
      sum.shift2 += dy2.row(p).transpose();
      sum.gain2 += dy2.row(p).cwiseProduct(normal2.row(p)).transpose();
    }
    gemm(kHidden2, kHidden1, n, transposed(row_major(dy2.data(), kHidden2)), row_major(h1.data(), kHidden1),
         sum.weight2.data(), kHidden1, true, Threads::serial);
    RowMatrixXf dy1(n, kHidden1);
    gemm(n, kHidden1, kHidden2, row_major(dy2.data(), kHidden2), row_major(scaled_w2.data(), kHidden1),
         dy1.data(), kHidden1, false, Threads::serial);
    for (Eigen::Index p = 0; p < n; ++p) {
      dy1.row(p) = (h1.row(p).array() > 0.0f).select(dy1.row(p), 0.0f);
      sum.first.row(0) += dy1.row(p);
      for (Eigen::Index a = 0; a < 3; ++a) sum.first.row(a + 1) += x(a, p) * dy1.row(p);
    }
  };
  return ordered_sum(clouds.size(), kCloudsPerBlock, Sparse{}, [&](std::size_t begin, std::size_t end) {
    Sparse sum;
    for (std::size_t i = begin; i < end; ++i) one(i, sum);
    return sum;
  });
}

void EncoderStep::backward(const std::vector<float>& parameters, const std::vector<Eigen::Matrix3Xf>& clouds,
                           const RowMatrixXf& latent_gradient, std::vector<float>& gradient) const {
  const auto& layers = parameter_layout().encoder;
  const Sparse sparse = critical_pass(parameters, clouds, latent_gradient);
  view(gradient, layers[2].weight) = sparse.weight3;
  vector_view(gradient, layers[2].shift) = sparse.bias3;
  vector_view(gradient, layers[1].gain) = sparse.gain2;
  vector_view(gradient, layers[1].shift) = sparse.shift2;

  // Norm 2: da2 = gain / s2 (dy2 - sum(dy2) / N - n2 sum(dy2 n2) / N), with n2 = (W2 h1 - mean2) / s2.
  const Eigen::MatrixXd w2 = view(parameters, layers[1].weight).cast<double>();
  const Eigen::VectorXd inverse2 = inverse_deviation(moments_[1]).cast<double>();
  const Eigen::VectorXd scale2 =
      vector_view(parameters, layers[1].gain).cast<double>().cwiseProduct(inverse2);
  const Eigen::VectorXd mean2 = moments_[1].mean.cast<double>();
  const Eigen::VectorXd shift2 = sparse.shift2.cast<double>(), gain2 = sparse.gain2.cast<double>();
  const Eigen::MatrixXd n2_h1 =
      inverse2.asDiagonal() * (w2 * h_second_ - mean2 * h_mean_.transpose());  // E[n2 h1^T]
  view(gradient, layers[1].weight) =
      (scale2.asDiagonal() *
       (sparse.weight2.cast<double>() - shift2 * h_mean_.transpose() - gain2.asDiagonal() * n2_h1))
          .cast<float>();

  // Its dense part reaches h1 of every point as q + Q h1.
  const Eigen::VectorXd slope = -scale2.cwiseProduct(gain2).cwiseProduct(inverse2) / points_;
  const RowMatrixXf big_q = (w2.transpose() * slope.asDiagonal() * w2).cast<float>();
  const Eigen::VectorXf q =
      (w2.transpose() * (-scale2.cwiseProduct(shift2) / points_ - slope.cwiseProduct(mean2))).cast<float>();
  const std::vector<float> q_panels = pack_panels(kHidden1, kHidden1, row_major(big_q.data(), kHidden1));
  const RowMatrixXf dense = ordered_sum(
      clouds.size(), kCloudsPerBlock, RowMatrixXf(RowMatrixXf::Zero(4, kHidden1)),
      [&](std::size_t begin, std::size_t end) {
        RowMatrixXf sums = RowMatrixXf::Zero(4, kHidden1);
        std::vector<float> scratch(kernel::kScratch);
        for (std::size_t i = begin; i < end; ++i)
          for (Eigen::Index first = 0; first < clouds[i].cols(); first += kernel::kBlock) {
            const int n = static_cast<int>(std::min<Eigen::Index>(kernel::kBlock, clouds[i].cols() - first));
            kernel::active_table().hidden1_backward(packed_.panels(), q_panels.data(), q.data(),
                                                    clouds[i].data() + 3 * first, n, sums.data(),
                                                    scratch.data());
          }
        return sums;
      });

  // Norm 1, whose input is W1 x.
  const Eigen::MatrixXd sums = (sparse.first + dense).cast<double>();
  const Eigen::VectorXd shift1 = sums.row(0).transpose();
  const Eigen::MatrixXd dy1_x = sums.bottomRows(3).transpose();  // sum of dy1 x^T, 64 x 3
  const Eigen::MatrixXd w1 = view(parameters, layers[0].weight).cast<double>();
  const Eigen::VectorXd inverse1 = inverse_deviation(moments_[0]).cast<double>();
  const Eigen::VectorXd mean1 = moments_[0].mean.cast<double>();
  const Eigen::VectorXd gain1 =
      inverse1.cwiseProduct(w1.cwiseProduct(dy1_x).rowwise().sum() - mean1.cwiseProduct(shift1));
  const Eigen::MatrixXd n1_x =
      inverse1.asDiagonal() * (w1 * x_second_ - mean1 * x_mean_.transpose());  // E[n1 x^T]
  const Eigen::VectorXd scale1 =
      vector_view(parameters, layers[0].gain).cast<double>().cwiseProduct(inverse1);
  vector_view(gradient, layers[0].gain) = gain1.cast<float>();
  vector_view(gradient, layers[0].shift) = shift1.cast<float>();
  view(gradient, layers[0].weight) =
      (scale1.asDiagonal() * (dy1_x - shift1 * x_mean_.transpose() - gain1.asDiagonal() * n1_x))
          .cast<float>();
}

}  // namespace polar
