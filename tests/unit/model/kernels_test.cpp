// Every instruction set against plain loops, and so against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/encoder_panels.hpp"
#include "model/gemm.hpp"
#include "polar/core/isa.hpp"
#include "polar/core/rng.hpp"
#include "polar/model/chamfer.hpp"
#include "polar/model/one_sided.hpp"

namespace polar {
namespace {

// 1024 products of order 1 in single precision, in another order: a few thousand units in the last place.
constexpr float kSumTolerance = 2e-4f;

class EachIsa : public testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    if (GetParam() > detected_isa()) GTEST_SKIP() << "this machine has no " << name(GetParam());
    limit_isa(GetParam());
    ASSERT_EQ(active_isa(), GetParam());
  }
  void TearDown() override { limit_isa(Isa::avx512); }
};

RowMatrixXf random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t item) {
  KeyedRandom random(1, item, 0);
  RowMatrixXf m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = static_cast<float>(random.normal());
  return m;
}

Eigen::Matrix3Xf random_cloud(Eigen::Index n, std::uint64_t item) {
  return random_matrix(n, 3, item).transpose() * 0.4f;
}

std::array<Linear, 3> random_encoder() {
  const auto layer = [](Eigen::Index out, Eigen::Index in, std::uint64_t item) {
    return Linear{random_matrix(out, in, item) / std::sqrt(static_cast<float>(in)),
                  random_matrix(out, 1, item + 50) * 0.1f};
  };
  return {layer(64, 3, 1), layer(128, 64, 2), layer(1024, 128, 3)};
}

RowMatrixXf channels(const std::array<Linear, 3>& l, const Eigen::Matrix3Xf& cloud) {
  const RowMatrixXf h1 = ((l[0].weight * cloud).colwise() + l[0].bias).cwiseMax(0.0f);
  const RowMatrixXf h2 = ((l[1].weight * h1).colwise() + l[1].bias).cwiseMax(0.0f);
  return (l[2].weight * h2).colwise() + l[2].bias;
}

TEST_P(EachIsa, encodesAsPlainLoops) {
  const std::array<Linear, 3> layers = random_encoder();
  const PackedEncoder encoder(layers);
  for (const Eigen::Index n : {1, 5, 8, 95, 96, 97, 500, 1024}) {
    const Eigen::Matrix3Xf cloud = random_cloud(n, 9);
    const RowMatrixXf all = channels(layers, cloud);
    const Encoded encoded = encoder.encode(cloud);
    for (Eigen::Index c = 0; c < 1024; ++c) {
      ASSERT_NEAR(encoded.latent[c], all.row(c).maxCoeff(), kSumTolerance) << "points " << n;
      ASSERT_GE(encoded.critical[c], 0);
      ASSERT_LT(encoded.critical[c], n);
      ASSERT_NEAR(encoded.latent[c], all(c, encoded.critical[c]), kSumTolerance);
    }
  }
}

TEST_P(EachIsa, multipliesMatricesOfAnyShape) {
  struct Shape {
    int m, n, k;
  };
  for (const Shape s : {Shape{1, 1, 1}, Shape{7, 33, 5}, Shape{64, 100, 129}, Shape{9, 31, 1024}}) {
    const RowMatrixXf a = random_matrix(s.m, s.k, 20), b = random_matrix(s.k, s.n, 21), bt = b.transpose();
    const RowMatrixXf expected = (a.cast<double>() * b.cast<double>()).cast<float>();
    for (const Threads threads : {Threads::serial, Threads::parallel}) {
      RowMatrixXf c = RowMatrixXf::Constant(s.m, s.n, 1.0f);
      gemm(s.m, s.n, s.k, row_major(a.data(), s.k), row_major(b.data(), s.n), c.data(), s.n, false, threads);
      EXPECT_LT((c - expected).cwiseAbs().maxCoeff(), kSumTolerance);
      gemm(s.m, s.n, s.k, row_major(a.data(), s.k), transposed(row_major(bt.data(), s.k)), c.data(), s.n,
           true, threads);
      EXPECT_LT((c - 2 * expected).cwiseAbs().maxCoeff(), 2 * kSumTolerance);
    }
  }
}

TEST_P(EachIsa, sumsGramMatrixAndBackwardOfFirstLayer) {
  const std::array<Linear, 3> layers = random_encoder();
  const PackedEncoder encoder(layers);
  const kernel::Table& table = kernel::active_table();
  const RowMatrixXf big_q = random_matrix(64, 64, 30);
  const Eigen::VectorXf q = random_matrix(64, 1, 31);
  const std::vector<float> panels = pack_panels(64, 64, row_major(big_q.data(), 64));
  for (const Eigen::Index n : {1, 13, 96}) {
    const Eigen::Matrix3Xf cloud = random_cloud(n, 32);
    const RowMatrixXf h = ((layers[0].weight * cloud).colwise() + layers[0].bias).cwiseMax(0.0f);
    RowMatrixXf gram = RowMatrixXf::Zero(kernel::kGramRows, 64);
    hidden1_blocks(encoder.panels(), cloud.data(), n,
                   [&](Eigen::Index, int, const float* block) { table.gram(block, gram.data()); });
    EXPECT_LT((gram.topRows(64) - h * h.transpose()).cwiseAbs().maxCoeff(), kSumTolerance);

    const RowMatrixXf d =
        (h.array() > 0.0f).select(((big_q.transpose() * h).colwise() + q).eval(), 0.0f);  // 64 x n
    RowMatrixXf expected(4, 64);
    expected.row(0) = d.rowwise().sum().transpose();
    expected.bottomRows(3) = cloud * d.transpose();
    RowMatrixXf sums = RowMatrixXf::Zero(4, 64);
    std::vector<float> scratch(kernel::kScratch);
    table.hidden1_backward(encoder.panels(), panels.data(), q.data(), cloud.data(), static_cast<int>(n),
                           sums.data(), scratch.data());
    EXPECT_LT((sums - expected).cwiseAbs().maxCoeff(), 10 * kSumTolerance);
  }
}

TEST_P(EachIsa, chamferAgreesWithBruteForceAndItsGradientWithDifferences) {
  const Eigen::Matrix3Xf a = random_cloud(77, 40), b = random_cloud(130, 41);
  const auto brute = [](const Eigen::Matrix3Xf& from, const Eigen::Matrix3Xf& to) {
    double sum = 0;
    for (Eigen::Index i = 0; i < from.cols(); ++i)
      sum += static_cast<double>((to.colwise() - from.col(i)).colwise().norm().minCoeff());
    return sum / static_cast<double>(from.cols());
  };
  const Chamfer distance = chamfer(a, b);
  EXPECT_NEAR(distance.a_to_b, brute(a, b), 1e-6);
  EXPECT_NEAR(distance.b_to_a, brute(b, a), 1e-6);
  EXPECT_EQ(chamfer(a, a).sum(), 0);

  Eigen::Matrix3Xf gradient;
  EXPECT_EQ(chamfer_gradient(a, b, gradient).sum(), distance.sum());
  constexpr float kStep = 1e-4f;
  for (Eigen::Index i = 0; i < a.cols(); i += 9)
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Eigen::Matrix3Xf more = a, less = a;
      more(axis, i) += kStep, less(axis, i) -= kStep;
      const double numeric =
          (chamfer(more, b).sum() - chamfer(less, b).sum()) / (2 * static_cast<double>(kStep));
      EXPECT_NEAR(numeric, static_cast<double>(gradient(axis, i)), 1e-3);
    }
}

TEST_P(EachIsa, weighsWhatLiesAboveApartFromWhatLiesBelow) {
  const OneSided weight{0.25f, 3.0f};
  for (const Eigen::Index n : {1, 31, 32, 100, 1024}) {
    const Eigen::VectorXf a = random_matrix(n, 1, 60), b = random_matrix(n, 1, 61);
    double expected = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double d = double{a[i]} - double{b[i]};
      expected += (d > 0 ? 0.25 : 3.0) * d * d;
    }
    EXPECT_NEAR(double{distance(a, b, weight)}, expected, 1e-6 * expected) << n;
    EXPECT_EQ(distance(a, a, weight), 0);
  }
}

TEST_P(EachIsa, adamwFollowsItsDefinition) {
  std::vector<float> w = {1, -2, 0.5f}, g = {0.1f, -0.3f, 0}, m = {0.2f, 0, -0.1f}, v = {0.04f, 0.01f, 0.09f};
  const kernel::AdamStep s{0.01f, 0.9f, 0.999f, 1e-8f, 0.001f, 0.5f, 0.25f};
  std::vector<double> expected;
  for (std::size_t i = 0; i < 3; ++i) {
    const double m1 = 0.9 * double{m[i]} + 0.1 * double{g[i]};
    const double v1 = 0.999 * double{v[i]} + 0.001 * double{g[i]} * double{g[i]};
    expected.push_back(double{w[i]} * (1 - 0.001) - 0.01 * (m1 / 0.5) / (std::sqrt(v1 / 0.25) + 1e-8));
  }
  kernel::active_table().adamw(3, w.data(), g.data(), m.data(), v.data(), s);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(double{w[i]}, expected[i], 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Kernels, EachIsa, testing::Values(Isa::portable, Isa::avx2, Isa::avx512),
                         [](const testing::TestParamInfo<Isa>& isa) { return name(isa.param); });

}  // namespace
}  // namespace polar
