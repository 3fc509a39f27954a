// Speed of readers, writers and the renderer. The floor of a reader is reading the same bytes whole, that of
// a writer is writing them whole (temporary name, fsync, rename, as every writer here does).
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "polar/results/fourier_shell.hpp"
#include "polar/results/picasso.hpp"
#include "polar/results/render.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/table_reader.hpp"
#include "support.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

constexpr int kParticles = 200;  // about 100,000 localisations

const smlm::LocalisationTable& table() {
  static const smlm::LocalisationTable the_table = bench::pores(kParticles).table;
  return the_table;
}

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of a file, read in one call.
double read_floor(const std::string& path) {
  std::string buffer(std::filesystem::file_size(path), '\0');
  return bench::fastest_seconds(5, [&] {
    std::ifstream in(path, std::ios::binary);
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    benchmark::DoNotOptimize(buffer.data());
  });
}

void read(benchmark::State& state, const std::string& path) {
  const double floor = read_floor(path);
  for (auto _ : state) benchmark::DoNotOptimize(smlm::read_table(path, {}).size());
  bench::rate(state, "bytes", static_cast<double>(std::filesystem::file_size(path)));
  bench::rate(state, "localisations", static_cast<double>(table().size()));
  bench::share_of_floor(state, floor);
  bench::peak_memory(state);
}

template <class Write>
void write(benchmark::State& state, const std::string& path, const support::TemporaryDirectory& directory,
           Write writer) {
  writer();
  const std::string bytes = content(path);
  const double floor =
      bench::fastest_seconds(3, [&] { smlm::write_file_atomically(directory.path("floor"), bytes); });
  for (auto _ : state) writer();
  bench::rate(state, "bytes", static_cast<double>(bytes.size()));
  bench::share_of_floor(state, floor);
}

void read_csv(benchmark::State& state) {
  const support::TemporaryDirectory directory;
  smlm::write_file_atomically(directory.path("t.csv"), format_table_csv(table()));
  read(state, directory.path("t.csv"));
}
BENCHMARK(read_csv)->UseRealTime()->Unit(benchmark::kMillisecond);

void read_picasso(benchmark::State& state) {
  const support::TemporaryDirectory directory;
  write_picasso(directory.path("t.hdf5"), table());
  read(state, directory.path("t.hdf5"));
}
BENCHMARK(read_picasso)->UseRealTime()->Unit(benchmark::kMillisecond);

void write_csv(benchmark::State& state) {
  const support::TemporaryDirectory directory;
  const std::string path = directory.path("t.csv");
  write(state, path, directory, [&] { smlm::write_file_atomically(path, format_table_csv(table())); });
}
BENCHMARK(write_csv)->UseRealTime()->Unit(benchmark::kMillisecond);

void write_points(benchmark::State& state) {
  const support::TemporaryDirectory directory;
  const std::string path = directory.path("t.hdf");
  write(state, path, directory, [&] { write_points_vtkhdf(path, table()); });
}
BENCHMARK(write_points)->UseRealTime()->Unit(benchmark::kMillisecond);

/// A superparticle's worth of localisations in one box of about 200 nm.
smlm::LocalisationTable superposed() {
  SimulationOptions o;
  o.particles = kParticles / 4;
  o.blinks_mean = 20;
  o.orientation = "identity";
  o.cramer_rao = false;
  return simulate(make_structure({}), o).table;
}

void render_superparticle(benchmark::State& state) {
  const smlm::LocalisationTable t = superposed();
  double voxels = 0;
  for (auto _ : state) {
    const Volume v = render(t);
    voxels = static_cast<double>(v.density.size());
    benchmark::DoNotOptimize(v.density.data());
  }
  bench::rate(state, "localisations", static_cast<double>(t.size()));
  bench::rate(state, "voxels", voxels);
  bench::peak_memory(state);
}
BENCHMARK(render_superparticle)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Two transforms of n^3 voxels, 5 n^3 log2 n^3 operations each by the usual count.
void fourier_shells_of_cubes(benchmark::State& state) {
  Volume v;
  const auto n = static_cast<std::size_t>(state.range(0));
  v.size = {n, n, n};
  v.density.assign(n * n * n, 1.0f);
  v.density[0] = 2;
  for (auto _ : state) benchmark::DoNotOptimize(fourier_shells(v, v).correlation.data());
  const auto points = static_cast<double>(n * n * n);
  bench::rate(state, "flops", 2 * 5 * points * std::log2(points));
  bench::peak_memory(state);
}
BENCHMARK(fourier_shells_of_cubes)->Arg(64)->Arg(128)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace polar

BENCHMARK_MAIN();
