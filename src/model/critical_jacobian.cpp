#include <vector>

#include "model/gemm.hpp"
#include "model/kernel_table.hpp"
#include "polar/model/pointnet.hpp"

namespace polar {

namespace {
using kernel::kHidden1;
using kernel::kLatent;

/// x W^T for the rows of x.
RowMatrixXf times_weight(const RowMatrixXf& x, const RowMatrixXf& weight) {
  RowMatrixXf y(x.rows(), weight.rows());
  gemm(static_cast<int>(x.rows()), static_cast<int>(weight.rows()), static_cast<int>(x.cols()),
       row_major(x.data(), x.cols()), transposed(row_major(weight.data(), weight.cols())), y.data(), y.cols(),
       false, Threads::serial);
  return y;
}
}  // namespace

Eigen::Matrix<float, Eigen::Dynamic, 3> critical_jacobian(const PointNetWeights& weights,
                                                          const Eigen::Ref<const Eigen::Matrix3Xf>& cloud,
                                                          const Encoded& encoded) {
  const auto& [first, second, third] = weights.encoder;
  // One point is critical for several channels: its Jacobian up to the second layer is computed once.
  std::vector<Eigen::Index> row_of(static_cast<std::size_t>(cloud.cols()), -1), point;
  for (const int p : encoded.critical)
    if (row_of[static_cast<std::size_t>(p)] < 0) {
      row_of[static_cast<std::size_t>(p)] = static_cast<Eigen::Index>(point.size());
      point.push_back(p);
    }
  const auto n = static_cast<Eigen::Index>(point.size());
  RowMatrixXf h1(n, kHidden1), j1(3 * n, kHidden1);  // row 3 p + a of j: derivative of point p along axis a
  for (Eigen::Index p = 0; p < n; ++p) {
    h1.row(p) = (first.weight * cloud.col(point[static_cast<std::size_t>(p)]) + first.bias).cwiseMax(0.0f);
    for (Eigen::Index a = 0; a < 3; ++a)
      j1.row(3 * p + a) = (h1.row(p).array() > 0.0f).select(first.weight.col(a).transpose(), 0.0f);
  }
  const RowMatrixXf y2 = times_weight(h1, second.weight);
  RowMatrixXf j2 = times_weight(j1, second.weight);
  for (Eigen::Index p = 0; p < n; ++p)
    for (Eigen::Index a = 0; a < 3; ++a)
      j2.row(3 * p + a) =
          ((y2.row(p) + second.bias.transpose()).array() > 0.0f).select(j2.row(3 * p + a), 0.0f);
  Eigen::Matrix<float, Eigen::Dynamic, 3> jacobian(kLatent, 3);
  for (Eigen::Index c = 0; c < kLatent; ++c) {
    const Eigen::Index p = row_of[static_cast<std::size_t>(encoded.critical[c])];
    jacobian.row(c) = third.weight.row(c) * j2.middleRows<3>(3 * p).transpose();
  }
  return jacobian;
}

}  // namespace polar
