#include "agreement.hpp"

#include <algorithm>

#include "polar/core/so3.hpp"
#include "polar/fusion/search_again.hpp"

namespace polar {

double agreement(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  const double same_rad = SearchAgainOptions().escape_rad;
  std::vector<Eigen::Matrix3d> between;
  for (std::size_t i = 0; i < a.size(); ++i) between.push_back(a[i].rotation * b[i].rotation.transpose());
  std::ptrdiff_t most = 0;
  for (const Eigen::Matrix3d& common : between)
    most = std::max(most, std::count_if(between.begin(), between.end(), [&](const Eigen::Matrix3d& d) {
                      return geodesic_angle(d, common) <= same_rad;
                    }));
  return between.empty() ? 0 : static_cast<double>(most) / static_cast<double>(between.size());
}

}  // namespace polar
