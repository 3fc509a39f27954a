#include "agreement.hpp"

#include <algorithm>

#include "polar/core/so3.hpp"
#include "polar/fusion/search_again.hpp"
#include "self_similarity.hpp"

namespace polar {

namespace {

// `b` in the frame of `a`, by the motion that takes most views there, and the views that it does not.
struct Compared {
  std::vector<Pose> b;
  std::vector<std::size_t> apart;
};

Compared compared(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  const double same_rad = SearchAgainOptions().escape_rad;
  std::vector<Eigen::Matrix3d> between;
  for (std::size_t i = 0; i < a.size(); ++i) between.push_back(a[i].rotation * b[i].rotation.transpose());
  std::ptrdiff_t most = -1;
  std::size_t common = 0;
  for (std::size_t k = 0; k < between.size(); ++k) {
    const auto alike = std::count_if(between.begin(), between.end(), [&](const Eigen::Matrix3d& d) {
      return geodesic_angle(d, between[k]) <= same_rad;
    });
    if (alike > most) most = alike, common = k;
  }
  Compared out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    out.b.push_back(a[common] * b[common].inverse() * b[i]);
    if (geodesic_angle(between[i], between[common]) > same_rad) out.apart.push_back(i);
  }
  return out;
}

double share_alike(std::size_t apart, std::size_t views) {
  return views == 0 ? 0 : 1 - static_cast<double>(apart) / static_cast<double>(views);
}

}  // namespace

double agreement(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return share_alike(compared(a, b).apart.size(), a.size());
}

double agreement_modulo_symmetry(const Mixture& template_of_a, bool planar, const std::vector<Pose>& a,
                                 const std::vector<Pose>& b) {
  const Compared moved = compared(a, b);
  const auto turned = static_cast<std::size_t>(twins(template_of_a, planar, a, moved.b, moved.apart));
  return share_alike(moved.apart.size() - turned, a.size());
}

}  // namespace polar
