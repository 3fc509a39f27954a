#include "initial_poses.hpp"

#include <map>

#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

std::vector<Pose> initial_poses(const std::string& path, const std::vector<smlm::Particle>& particles,
                                const Normalisation& normalisation, Progress& progress) {
  std::map<std::string, Pose> known;
  for (const PoseRow& row : read_pose_table(path))
    if (row.template_from_view) known.emplace(row.particle, *row.template_from_view);
  std::vector<Pose> poses(particles.size());
  std::size_t found = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto at = known.find(particles[i].name);
    if (at == known.end()) continue;
    ++found;
    const Pose& nm = at->second;
    const Eigen::Vector3d centre = nm * normalisation.centre_nm[i];
    poses[i] = {nm.rotation, centre / normalisation.scale_nm};
  }
  if (found < 2)
    throw smlm::Error(smlm::Fault::input, path,
                      "has poses of " + std::to_string(found) + " of the " +
                          std::to_string(particles.size()) + " particles",
                      "name the particles there as in input.files");
  if (found < particles.size())
    progress.note("warning: " + path + " has no pose of " + std::to_string(particles.size() - found) +
                  " particles: they are searched from nothing");
  return poses;
}

}  // namespace polar::pipeline
