// Speed of what a registration spends its time on: the rotation graph, FLAMES' look-ups, pose refinement, the
// EM sweep, each on 1 and on 2 threads. Counters: look-ups or dense pairs (localisations x centres, those
// that are skipped as too far included) a second, and the share of a floor where there is one.
#include <algorithm>
#include <cmath>

#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/flames/local_minima.hpp"
#include "polar/flames/rotation_grid.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/pose_search.hpp"
#include "support.hpp"

namespace polar {
namespace {

constexpr int kParticles = 40, kCentres = 256, kRotations = 2304, kNeighbours = 11;
constexpr double kWidth = 0.05;  // template units

/// Pores at their true poses under a template of centres drawn from their own localisations.
struct Scene {
  Scene() : simulation(bench::pores(kParticles)) {
    smlm::ParticleSet set = smlm::group_particles(simulation.table);
    views = prepare_views(set);
    noise.width = kWidth;
    const Normalisation& n = views.normalisation;
    KeyedRandom random(1, 0, 1);
    for (std::size_t i = 0; i < views.view.size(); ++i) {
      const Pose& truth = simulation.particle[i].structure_from_view;
      pose.push_back({truth.rotation, truth * n.centre_nm[i] / n.scale_nm});
      axes.push_back(uncertainty_axis(views.view[i], false));
      localisations += static_cast<double>(views.view[i].points.cols());
    }
    mixture.centre.resize(3, kCentres);
    mixture.weight = Eigen::VectorXf::Constant(kCentres, 1.0f / kCentres);
    for (int k = 0; k < kCentres; ++k) {
      const std::size_t i = random.below(views.view.size());
      const auto j = random.below(static_cast<std::uint64_t>(views.view[i].points.cols()));
      const Eigen::Vector3d x = views.view[i].points.col(static_cast<Eigen::Index>(j)).cast<double>();
      mixture.centre.col(k) = (pose[i] * x).cast<float>();
    }
    sort_into_blocks(mixture);
  }
  Simulation simulation;
  Views views;
  std::vector<Eigen::Vector3f> axes;
  std::vector<Pose> pose;
  NoiseModel noise;
  Mixture mixture;
  double localisations = 0;
};

const Scene& scene() {
  static const Scene the_scene;
  return the_scene;
}

/// Graph of the grid; the floor is the same distances, every pair once, as one matrix product.
void rotation_graph(benchmark::State& state) {
  const auto grid = super_fibonacci(static_cast<int>(state.range(0)));
  const auto n = static_cast<Eigen::Index>(grid.size());
  Eigen::MatrixXf q(4, n);
  for (Eigen::Index i = 0; i < n; ++i) q.col(i) = grid[static_cast<std::size_t>(i)].coeffs();
  Eigen::MatrixXf product(n, n);
  const double floor = bench::fastest_seconds(3, [&] {
    product.noalias() = q.transpose() * q;
    benchmark::DoNotOptimize(product.data());
  });
  for (auto _ : state) benchmark::DoNotOptimize(neighbour_graph(grid, kNeighbours));
  bench::rate(state, "rotations", static_cast<double>(n));
  bench::share_of_floor(state, floor);
}
BENCHMARK(rotation_graph)->Arg(576)->Arg(2304)->UseRealTime()->Unit(benchmark::kMillisecond);

void minima_of_grid(benchmark::State& state) {
  const NeighbourGraph graph = neighbour_graph(super_fibonacci(kRotations), kNeighbours);
  KeyedRandom random(1, 0, 2);
  std::vector<float> cost(kRotations);
  for (float& c : cost) c = static_cast<float>(random.uniform());
  for (auto _ : state) benchmark::DoNotOptimize(local_minima(cost, graph, 8));
  bench::rate(state, "comparisons", static_cast<double>(kRotations) * kNeighbours);
}
BENCHMARK(minima_of_grid);

void blurred_volumes(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const Scene& s = scene();
  const SigmaClasses classes = sigma_classes(s.views, s.axes, s.noise, 3);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        DirectionVolumes(s.mixture, classes, directions_for(classes, false), false).directions());
  bench::peak_memory(state);
}
BENCHMARK(blurred_volumes)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// FLAMES' inner loop on one core; the floor reads as many 16-bit values at random from a table of 128 KiB.
void flames_look_ups(benchmark::State& state) {
  const Scene& s = scene();
  const SigmaClasses classes = sigma_classes(s.views, s.axes, s.noise, 3);
  const DirectionVolumes volumes(s.mixture, classes, directions_for(classes, false), false);
  std::vector<std::uint32_t> all(static_cast<std::size_t>(s.views.view[0].points.cols()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  const SearchView view = search_view(s.views.view[0], s.axes[0], s.noise, classes, all);
  std::vector<Eigen::Matrix3f> rotation;
  for (const auto& q : super_fibonacci(kRotations)) rotation.push_back(q.toRotationMatrix());
  const double look_ups = static_cast<double>(view.count) * kRotations;

  std::vector<std::int16_t> table(1 << 16, 1);
  std::vector<std::uint16_t> index(1 << 14);
  KeyedRandom random(1, 0, 3);
  for (auto& i : index) i = static_cast<std::uint16_t>(random.below(table.size()));
  const double floor = bench::fastest_seconds(20, [&] {
    std::int32_t sum = 0;
    for (const std::uint16_t i : index) sum += table[i];
    benchmark::DoNotOptimize(sum);
  });
  for (auto _ : state) {
    float best = -1e30f;
    for (const Eigen::Matrix3f& r : rotation)
      best = std::max(best, volumes.score(view, volumes.direction_of(view, r), r, Eigen::Vector3f::Zero()));
    benchmark::DoNotOptimize(best);
  }
  bench::rate(state, "look_ups", look_ups);
  bench::share_of_floor(state, floor * look_ups / static_cast<double>(index.size()));
}
BENCHMARK(flames_look_ups)->UseRealTime()->Unit(benchmark::kMillisecond);

void view_likelihoods(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const Scene& s = scene();
  const FusionData data(s.views, s.axes, s.noise);
  for (auto _ : state) benchmark::DoNotOptimize(mean_log_likelihood(s.mixture, data, s.pose));
  bench::rate(state, "dense_pairs", s.localisations * kCentres);
}
BENCHMARK(view_likelihoods)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Four evaluations with gradient and curvature a pose; the floor is as many evaluations of the likelihood
/// alone.
void pose_refinement(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  constexpr int kEvaluations = 4;
  const Scene& s = scene();
  const FusionData data(s.views, s.axes, s.noise);
  const double floor = kEvaluations * bench::fastest_seconds(5, [&] {
                         benchmark::DoNotOptimize(mean_log_likelihood(s.mixture, data, s.pose));
                       });
  for (auto _ : state) {
    std::vector<Pose> pose = s.pose;
    benchmark::DoNotOptimize(refine_poses(s.mixture, data, pose, kEvaluations));
  }
  bench::rate(state, "dense_pairs", kEvaluations * s.localisations * kCentres);
  bench::share_of_floor(state, floor);
}
BENCHMARK(pose_refinement)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// One EM step of the template; the floor is one evaluation of the likelihood of the same localisations.
void em_sweep(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  const Scene& s = scene();
  const FusionData data(s.views, s.axes, s.noise);
  const double floor = bench::fastest_seconds(
      5, [&] { benchmark::DoNotOptimize(mean_log_likelihood(s.mixture, data, s.pose)); });
  for (auto _ : state) {
    Mixture mixture = s.mixture;
    benchmark::DoNotOptimize(maximise(mixture, data, s.pose, {}).log_likelihood);
  }
  bench::rate(state, "dense_pairs", s.localisations * kCentres);
  bench::share_of_floor(state, floor);
  bench::peak_memory(state);
}
BENCHMARK(em_sweep)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polar

BENCHMARK_MAIN();
