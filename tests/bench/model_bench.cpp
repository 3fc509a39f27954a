// Speed of the model on one core: the fused encoder beside a plain product of the same shape (the roofline it
// is judged by), derivatives, decoder, Chamfer distance, and a whole training step.
#include <benchmark/benchmark.h>

#include "model/encoder_panels.hpp"
#include "model/gemm.hpp"
#include "model/network_step.hpp"
#include "model/procedural.hpp"
#include "polar/core/isa.hpp"
#include "polar/core/parallel.hpp"
#include "polar/model/chamfer.hpp"
#include "polar/model/pointnet.hpp"

namespace polar {
namespace {

constexpr int kPoints = 1024;
constexpr double kEncoderFlops = 2.0 * kPoints * (3 * 64 + 64 * 128 + 128 * 1024);

/// Leaves the benchmark with an error where the machine lacks the instruction set of its argument.
bool choose_isa(benchmark::State& state) {
  const auto isa = static_cast<Isa>(state.range(0));
  limit_isa(isa);
  state.SetLabel(name(isa));
  if (active_isa() != isa) state.SkipWithError("this machine lacks the instruction set");
  return active_isa() == isa;
}

void count_flops(benchmark::State& state, double flops) {
  state.counters["flops"] = benchmark::Counter(flops * static_cast<double>(state.iterations()),
                                               benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
}

PointNetWeights weights() { return folded(initial_parameters(1), initial_moments()); }

Eigen::Matrix3Xf cloud(std::uint64_t item) {
  KeyedRandom random(1, item, 0);
  return procedural_cloud(kPoints, random);
}

void encode(benchmark::State& state) {
  if (!choose_isa(state)) return;
  const PackedEncoder encoder(weights().encoder);
  const Eigen::Matrix3Xf x = cloud(0);
  for (auto _ : state) benchmark::DoNotOptimize(encoder.encode(x));
  count_flops(state, kEncoderFlops);
}
BENCHMARK(encode)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

void plain_product(benchmark::State& state) {
  if (!choose_isa(state)) return;
  const RowMatrixXf a = RowMatrixXf::Random(kPoints, 128), b = RowMatrixXf::Random(128, 1024);
  RowMatrixXf c(kPoints, 1024);
  for (auto _ : state) {
    gemm(kPoints, 1024, 128, row_major(a.data(), 128), row_major(b.data(), 1024), c.data(), 1024, false,
         Threads::serial);
    benchmark::DoNotOptimize(c.data());
  }
  count_flops(state, 2.0 * kPoints * 128 * 1024);
}
BENCHMARK(plain_product)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

/// Products of registers alone: what the core can do at most.
void peak(benchmark::State& state) {
  if (!choose_isa(state)) return;
  constexpr int kDepth = 256;  // both operands stay in the first-level cache
  const std::vector<float> a(static_cast<std::size_t>(kernel::kMaxTileRows * kDepth), 1.0f);
  const std::vector<float> b(static_cast<std::size_t>(kernel::kPanel * kDepth), 1.0f);
  std::vector<float> c(static_cast<std::size_t>(kernel::kMaxTileRows * kernel::kPanel));
  const kernel::Table& table = kernel::active_table();
  for (auto _ : state) {
    table.gemm_panel(table.tile_rows, kernel::kPanel, kDepth, a.data(), b.data(), c.data(), kernel::kPanel,
                     false);
    benchmark::DoNotOptimize(c.data());
  }
  count_flops(state, 2.0 * table.tile_rows * kernel::kPanel * kDepth);
}
BENCHMARK(peak)->Arg(0)->Arg(1)->Arg(2);

void pose_jacobian(benchmark::State& state) {
  limit_isa(Isa::avx512);
  const auto model = make_pointnet(weights());
  const Eigen::Matrix3Xf x = cloud(0);
  const Encoded encoded = model->encode(x);
  for (auto _ : state) benchmark::DoNotOptimize(model->pose_jacobian(x, encoded));
}
BENCHMARK(pose_jacobian)->Unit(benchmark::kMillisecond);

void decode(benchmark::State& state) {
  const auto model = make_pointnet(weights());
  const Eigen::VectorXf z = model->encode(cloud(0)).latent;
  for (auto _ : state) benchmark::DoNotOptimize(model->decode(z));
}
BENCHMARK(decode)->Unit(benchmark::kMillisecond);

void chamfer_with_gradient(benchmark::State& state) {
  const Eigen::Matrix3Xf a = cloud(0), b = cloud(1);
  Eigen::Matrix3Xf gradient;
  for (auto _ : state) benchmark::DoNotOptimize(chamfer_gradient(a, b, gradient));
}
BENCHMARK(chamfer_with_gradient)->Unit(benchmark::kMillisecond);

/// Examples, loss and gradient of 64 clouds; items are clouds.
void training_step(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  constexpr std::size_t kClouds = 64;
  const std::vector<float> parameters = initial_parameters(1);
  std::vector<float> gradient;
  std::vector<TrainingCloud> batch(kClouds);
  NetworkStep step;
  std::uint64_t item = 0;
  for (auto _ : state) {
    parallel_for(kClouds, [&](std::size_t i) { batch[i] = training_cloud(1, item + i, {}, {}, {}); });
    benchmark::DoNotOptimize(step.loss(parameters, batch, {1, item, 0.1}, gradient));
    item += kClouds;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kClouds));
}
BENCHMARK(training_step)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polar

BENCHMARK_MAIN();
