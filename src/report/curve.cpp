#include "curve.hpp"

#include "polar/core/rng.hpp"
#include "polar/results/half_maps.hpp"
#include "polar/results/results.hpp"

namespace polar::report {

namespace {
constexpr std::uint32_t kOrderStage = 0xA2;
constexpr std::size_t kFewest = 4;  // particles a point
constexpr std::size_t kMostVoxels = 96, kMostPlanarVoxels = 384;

smlm::LocalisationTable of_particles(const smlm::LocalisationTable& t, const std::vector<bool>& particle) {
  std::vector<bool> wanted;
  for (const std::int64_t p : t.particle) wanted.push_back(p >= 0 && particle[static_cast<std::size_t>(p)]);
  return rows_to_draw(t, wanted);
}
}  // namespace

ResolutionCurve curve_of_common_poses(const Subject& subject) {
  const RunRecord& record = subject.record;
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < record.poses.size(); ++i)
    if (record.poses[i].accepted) accepted.push_back(i);
  const std::vector<std::uint32_t> order =
      random_order(accepted.size(), KeyedRandom(record.seed, 0, kOrderStage));
  const std::size_t most = subject.points.planar ? kMostPlanarVoxels : kMostVoxels;
  ResolutionCurve curve;
  for (const std::size_t divisor : {8u, 4u, 2u, 1u}) {
    const std::size_t n = accepted.size() / divisor;
    if (n < kFewest) continue;
    std::vector<bool> half[2] = {std::vector<bool>(record.poses.size()),
                                 std::vector<bool>(record.poses.size())};
    for (std::size_t k = 0; k < n; ++k) half[k % 2][accepted[order[k]]] = true;
    const RenderOptions& drawing = record.result.render;
    const DrawnShells drawn = shells_between(of_particles(subject.points, half[0]), drawing,
                                             of_particles(subject.points, half[1]), drawing, most);
    curve.particles.push_back(static_cast<double>(n));
    curve.resolution_nm.push_back(shell_resolution(drawn.shells).period_nm);
  }
  return curve;
}

}  // namespace polar::report
