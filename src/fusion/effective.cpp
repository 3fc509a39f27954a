#include "polar/fusion/effective.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localisations.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"

namespace polar {

namespace {
constexpr float kCutOff = 4.0f;              // standard deviations; as in the kernel
constexpr float kNearlyIsotropic = 1.02f;    // ratio of standard deviations below which no axis is told apart
constexpr float kSmallestVariance = 1e-10f;  // (1e-5 of the particle radius)^2: "exact" localisations
}  // namespace

Eigen::Vector3f uncertainty_axis(const View& view, bool planar) {
  if (planar || view.covariance.empty()) return Eigen::Vector3f::UnitZ();
  Eigen::Matrix3f mean = Eigen::Matrix3f::Zero();
  for (const Symmetric3& c : view.covariance)
    mean += matrix3f(c) / std::max(c[0] + c[3] + c[5], kSmallestVariance);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen(mean);
  const Eigen::Vector3f& v = eigen.eigenvalues();
  if (v[2] < kNearlyIsotropic * kNearlyIsotropic * v[0]) return Eigen::Vector3f::UnitZ();
  const bool prolate = v[2] * v[0] > v[1] * v[1];
  return eigen.eigenvectors().col(prolate ? 2 : 0);
}

AxialSigma axial_sigma(const Symmetric3& covariance, const Eigen::Vector3f& axis) {
  const Eigen::Matrix3f c = matrix3f(covariance);
  const float along = axis.dot(c * axis);
  return {std::sqrt(std::max(0.0f, 0.5f * (c.trace() - along))), std::sqrt(std::max(0.0f, along))};
}

Symmetric3 effective_covariance(const Symmetric3& stated, const Eigen::Vector3f& axis,
                                const NoiseModel& noise) {
  const auto al = static_cast<float>(noise.lateral_factor), aa = static_cast<float>(noise.axial_factor);
  const auto bl = static_cast<float>(noise.lateral_extra * noise.lateral_extra + noise.width * noise.width);
  const auto ba = static_cast<float>(noise.axial_extra * noise.axial_extra + noise.width * noise.width);
  if (al == aa && bl == ba) {  // no direction is told apart: the same numbers with fewer products
    const float b = bl + kSmallestVariance;
    return {al * stated[0] * al + b, al * stated[1] * al, al * stated[2] * al,
            al * stated[3] * al + b, al * stated[4] * al, al * stated[5] * al + b};
  }
  const Eigen::Matrix3f along = axis * axis.transpose();
  const Eigen::Matrix3f factor = al * Eigen::Matrix3f::Identity() + (aa - al) * along;
  const Eigen::Matrix3f c = factor * matrix3f(stated) * factor +
                            (bl + kSmallestVariance) * Eigen::Matrix3f::Identity() + (ba - bl) * along;
  return {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
}

KernelLocalisations kernel_localisations(const View& view, const Eigen::Vector3f& axis,
                                         const NoiseModel& noise, const std::vector<std::uint32_t>& subset) {
  const std::size_t n = subset.empty() ? view.covariance.size() : subset.size();
  KernelLocalisations out(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t j = subset.empty() ? k : subset[k];
    const Eigen::Vector3f x = view.points.col(static_cast<Eigen::Index>(j));
    kernel::Localisation& l = out[k];
    if (k > 0 && view.covariance[j] == view.covariance[subset.empty() ? k - 1 : subset[k - 1]]) {
      l = out[k - 1];  // many tables have one uncertainty for a whole particle
      l.x = x.x(), l.y = x.y(), l.z = noise.planar ? 0 : x.z();
      continue;
    }
    const Symmetric3 c = effective_covariance(view.covariance[j], axis, noise);
    if (noise.planar) {
      const float det = c[0] * c[3] - c[1] * c[1], half = 0.5f * (c[0] + c[3]);
      const float spread = std::sqrt(std::max(0.0f, half * half - det));
      l = {x.x(),
           x.y(),
           0,
           c[3] / det,
           -c[1] / det,
           0,
           c[0] / det,
           0,
           0,
           1.0f / (kTwoPiF * std::sqrt(det)),
           1.0f / std::sqrt(std::max(half - spread, kSmallestVariance)),
           kCutOff * std::sqrt(half + spread)};
      continue;
    }
    const Eigen::Matrix3f m = matrix3f(c);
    const Eigen::Matrix3f p = m.inverse();
    // Bounds of the extreme eigenvalues are enough for the cut-off, and cheaper than the eigenvalues.
    const float largest = m.cwiseAbs().rowwise().sum().maxCoeff();
    const float sharpest = p.cwiseAbs().rowwise().sum().maxCoeff();
    l = {x.x(),
         x.y(),
         x.z(),
         p(0, 0),
         p(0, 1),
         p(0, 2),
         p(1, 1),
         p(1, 2),
         p(2, 2),
         1.0f / std::sqrt(kTwoPiF * kTwoPiF * kTwoPiF * m.determinant()),
         std::sqrt(sharpest),
         kCutOff * std::sqrt(largest)};
  }
  return out;
}

}  // namespace polar
