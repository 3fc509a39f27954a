#include "halves.hpp"

#include <map>

#include "polar/core/rng.hpp"
#include "polar/registration/prepare.hpp"
#include "polar/results/half_maps.hpp"
#include "smlm/repetitions.hpp"

namespace polar::pipeline {

namespace {
constexpr std::uint32_t kSplitStage = 0x91;
constexpr std::size_t kFewestParticles = 4;

}  // namespace

std::vector<bool> second_half(const smlm::ParticleSet& set, std::uint64_t seed) {
  const std::size_t n = set.particles.size();
  const std::vector<std::uint32_t> order = random_order(n, KeyedRandom(seed, 0, kSplitStage));
  std::vector<bool> second(n);
  for (std::size_t i = 0; i < n; ++i) second[order[i]] = i % 2 == 1;
  const smlm::Repetitions repetitions = smlm::find_repetitions(set.table);
  if (repetitions.particles == 0) return second;
  std::map<std::uint32_t, bool> half_of_original;
  for (std::size_t i = 0; i < n; ++i) {
    if (set.particles[i].rows.empty()) continue;
    const std::int64_t named = set.table.particle[set.particles[i].rows.front()];
    const std::uint32_t original = repetitions.original[static_cast<std::size_t>(named)];
    second[i] = half_of_original.emplace(original, second[i]).first->second;
  }
  return second;
}

namespace {
Results registered(const smlm::ParticleSet& all, const std::vector<bool>& second, bool want_second,
                   RegistrationOptions options, Progress& progress, Checkpoint& checkpoint,
                   const Engine& engine) {
  Results r;
  r.particles.table = all.table;
  for (std::size_t i = 0; i < all.particles.size(); ++i)
    if (second[i] == want_second) r.particles.particles.push_back(all.particles[i]);
  // The halves share no random number either.
  options.seed = KeyedRandom(options.seed, want_second ? 2 : 1, kSplitStage).bits();
  if (options.symmetry == "detect") options.symmetry = "none";  // of the whole; nobody asks it of a half
  Views views = prepare_views(r.particles);
  PartOfCheckpoint here(checkpoint, want_second ? "second" : "first");
  r.registration = engine(views, options, progress, here);
  r.normalisation = std::move(views.normalisation);
  r.planar = views.planar;
  return r;
}

// Takes the poses that were found where none was accepted; whether it had to.
bool takes_refused(Results& r) {
  if (accepted_particles(r) > 0) return false;
  for (RegisteredView& v : r.registration.view)
    v.accepted = v.n_used > 0 && v.template_from_view.rotation.allFinite() &&
                 v.template_from_view.translation.allFinite();
  return true;
}

HalfMaps half_maps(const smlm::ParticleSet& particles, const std::vector<bool>& second,
                   const RegistrationOptions& options, Progress& progress, Checkpoint& checkpoint,
                   const Engine& engine, const Results* whole) {
  Results a = registered(particles, second, false, options, progress, checkpoint, engine);
  if (progress.cancelled()) return {};
  Results b = registered(particles, second, true, options, progress, checkpoint, engine);
  if (progress.cancelled()) return {};
  const bool refused_a = takes_refused(a), refused_b = takes_refused(b);
  HalfMaps maps = compare_half_maps(a, b, options.seed, whole);
  maps.refused = refused_a || refused_b;
  if (refused_a) maps.first_particles = 0;
  if (refused_b) maps.second_particles = 0;
  if (maps.refused) maps.resolution = {};
  return maps;
}
}  // namespace

ResolutionReport resolve_halves(const Results& whole, const RegistrationOptions& options, Progress& progress,
                                Checkpoint& checkpoint, const Engine& engine) {
  const smlm::ParticleSet& particles = whole.particles;
  ResolutionReport report;
  PartOfCheckpoint data(checkpoint, "data"), noise(checkpoint, "noise");
  if (particles.particles.size() < kFewestParticles) return report;
  const std::vector<bool> second = second_half(particles, options.seed);
  report.data = half_maps(particles, second, options, progress, data, engine, &whole);
  if (progress.cancelled()) return report;
  report.noise =
      half_maps(noise_particles(particles, options.seed), second, options, progress, noise, engine, nullptr);
  return report;
}

}  // namespace polar::pipeline
