#include "named_poses.hpp"

#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

NamedPoses read_named_poses(const std::string& path) {
  NamedPoses poses;
  for (const PoseRow& row : read_pose_table(path))
    if (!poses.emplace(row.particle, row.template_from_view).second)
      throw smlm::Error(smlm::Fault::input, path, "particle '" + row.particle + "' occurs twice",
                        "give the poses of one run");
  return poses;
}

}  // namespace polar::pipeline
