#include "pose_terms.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kernel_choice.hpp"

namespace polar {

namespace {

constexpr float kLeastResponsibility = 1e-3f;  // of a centre for a localisation to count as its pair

// L with L L^T = s, of a matrix that is positive semidefinite.
Eigen::Matrix3d lower_root(const Eigen::Matrix3d& s) {
  Eigen::Matrix3d l = Eigen::Matrix3d::Zero();
  const double least = 1e-12 * s.trace();  // rounding of a direction without spread
  for (int c = 0; c < 3; ++c) {
    const double pivot = s(c, c) - l.row(c).head(c).squaredNorm();
    if (pivot <= least) continue;
    l(c, c) = std::sqrt(pivot);
    for (int r = c + 1; r < 3; ++r) l(r, c) = (s(r, c) - l.row(r).head(c).dot(l.row(c).head(c))) / l(c, c);
  }
  return l;
}

}  // namespace

std::vector<Eigen::Matrix3d> roots_of(const KernelLocalisations& view) {
  std::vector<Eigen::Matrix3d> roots;
  for (const kernel::Localisation& l : view) {
    Eigen::Matrix3f p;
    p << l.pxx, l.pxy, l.pxz, l.pxy, l.pyy, l.pyz, l.pxz, l.pyz, l.pzz;
    // It may be singular (planar): its root by eigenvalues.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(p.cast<double>());
    roots.emplace_back(eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
                       eigen.eigenvectors().transpose());
  }
  return roots;
}

std::vector<Term> terms_at(const Mixture& m, const kernel::Centres& centres, float background,
                           const KernelLocalisations& view, const std::vector<Eigen::Matrix3d>& roots) {
  std::vector<Term> terms;
  const auto padded = static_cast<std::size_t>(centres.blocks * kernel::kBlock);
  std::vector<int> index(padded);
  std::vector<float> density(padded);
  for (std::size_t j = 0; j < view.size(); ++j) {
    const kernel::Localisation& l = view[j];
    const auto near = static_cast<std::size_t>(
        kernel::kBlock * mixture_kernel().weighted_densities(centres, l, index.data(), density.data()));
    float total = background;
    for (std::size_t k = 0; k < near; ++k) total += density[k];
    double sum = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < near; ++k) {
      if (!(density[k] > kLeastResponsibility * total)) continue;
      const double r = static_cast<double>(density[k] / total);
      const Eigen::Vector3d mu = m.centre.col(index[k]).cast<double>();
      sum += r, mean += r * mu, square += r * mu * mu.transpose();
    }
    if (sum == 0) continue;
    mean /= sum;
    terms.push_back({mean, {l.x, l.y, l.z}, std::sqrt(sum) * roots[j], true});
    const Eigen::Matrix3d spread = lower_root(square - sum * mean * mean.transpose());
    for (int a = 0; a < 3; ++a)
      if (spread(a, a) > 0) terms.push_back({spread.col(a), Eigen::Vector3d::Zero(), roots[j], false});
  }
  return terms;
}

}  // namespace polar
