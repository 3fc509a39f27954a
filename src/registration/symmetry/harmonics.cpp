#include "harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "../data/bursts.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {

constexpr float kNearAxis = 0.2f;  // particle radii: nearer to the axis an azimuth says little

using Phasor = std::complex<double>;

// exp(i n phi) of a localisation; 0 near the axis.
Phasor phasor(const Problem& problem, std::size_t view, std::uint32_t j, const SoftPose& pose, int order) {
  const Eigen::Vector3f x =
      pose.rotation * problem.views.view[view].points.col(static_cast<Eigen::Index>(j)) + pose.translation;
  if (std::hypot(x.x(), x.y()) < kNearAxis) return 0;
  return std::polar(1.0, order * static_cast<double>(std::atan2(x.y(), x.x())));
}

// Mean of cos(n difference) over pairs of bursts, each burst one phasor; NaN of fewer than two.
double pair_mean(const std::map<int, std::vector<Phasor>>& of_burst) {
  Phasor sum = 0;
  double squares = 0, n = 0;
  for (const auto& [number, phasors] : of_burst) {
    Phasor mean = 0;
    for (const Phasor& p : phasors) mean += p;
    mean /= static_cast<double>(phasors.size());
    sum += mean, squares += std::norm(mean), ++n;
  }
  return n > 1 ? (std::norm(sum) - squares) / (n * (n - 1)) : NAN;
}

}  // namespace

std::vector<AxialHarmonic> axial_harmonics(const Problem& problem, const SymmetryOptions& options,
                                           const std::vector<SoftPose>& pose, const std::vector<int>& which) {
  std::vector<std::vector<double>> mean(which.size());  // of every view, by order
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    const std::vector<int> burst = bursts(problem.views.view[i], problem.axes[i], problem.noise,
                                          problem.sampled[i], options.burst_distance);
    for (int order = 1; order <= options.highest_order + 1; ++order) {
      std::map<int, std::vector<Phasor>> of_burst;
      for (const std::uint32_t j : problem.sampled[i]) {
        const Phasor p = phasor(problem, i, j, pose[i], order);
        if (p != Phasor(0)) of_burst[burst[j]].push_back(p);
      }
      mean[k].push_back(pair_mean(of_burst));
    }
  });
  std::vector<AxialHarmonic> out;
  for (int order = 2; order <= options.highest_order; ++order) {
    const Evidence nothing(which.size(), 0.0);
    // What bursts share or keep from each other raises or lowers neighbouring orders alike.
    Evidence found;
    const auto n = static_cast<std::size_t>(order - 1);
    for (const auto& m : mean) found.push_back(m[n] - (m[n - 1] + m[n + 1]) / 2);
    const Comparison c = compare(nothing, found);
    out.push_back({order, c.standard_error > 0 ? c.gain / c.standard_error : 0});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.significance > b.significance; });
  return out;
}

void align_azimuths(const Problem& problem, int order, const std::vector<int>& which,
                    std::vector<SoftPose>& pose) {
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    Phasor sum = 0;
    for (const std::uint32_t j : problem.sampled[i]) sum += phasor(problem, i, j, pose[i], order);
    if (sum == Phasor(0)) return;
    const Eigen::Matrix3f back =
        Eigen::AngleAxisf(static_cast<float>(-std::arg(sum) / order), Eigen::Vector3f::UnitZ())
            .toRotationMatrix();
    pose[i] = {back * pose[i].rotation, back * pose[i].translation};
  });
}

}  // namespace polar
