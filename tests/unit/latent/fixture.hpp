// Shapes, views and networks for the tests of the latent layer.
#pragma once

#include <cmath>

#include "polar/core/covariance3.hpp"
#include "polar/core/pose.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/view.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/model/weights_file.hpp"

namespace polar::fixture {

/// Points in three bars of different lengths: no symmetry, radius about 1.
inline Eigen::Matrix3Xf three_bars(int points, std::uint64_t seed) {
  KeyedRandom random(seed, 0, 1);
  Eigen::Matrix3Xf cloud(3, points);
  for (int j = 0; j < points; ++j) {
    const double u = random.uniform(), along = random.uniform();
    const double a = 0.15 * (2 * random.uniform() - 1), b = 0.15 * (2 * random.uniform() - 1);
    const Eigen::Vector3d p = u < 0.5   ? Eigen::Vector3d(1.7 * along - 0.85, a, b)
                              : u < 0.8 ? Eigen::Vector3d(-0.7 + a, 0.9 * along, b)
                                        : Eigen::Vector3d(0.3 + a, b, 0.6 * along);
    cloud.col(j) = p.cast<float>();
  }
  return cloud;
}

/// z_c = max over points of sin(w_c . x + b_c), D(z) linear: smooth but for the maximum, so that single
/// precision is enough for differences.
class WavyAutoencoder : public Autoencoder {
 public:
  explicit WavyAutoencoder(int latent = 24, int decoded = 40)
      : w_(latent, 3), b_(latent), d_(3 * decoded, latent) {
    KeyedRandom random(11, 0, 2);
    for (auto* m : {static_cast<Eigen::MatrixXf*>(&w_), &d_})
      for (Eigen::Index i = 0; i < m->size(); ++i) m->data()[i] = static_cast<float>(random.normal());
    for (Eigen::Index i = 0; i < latent; ++i) b_[i] = static_cast<float>(random.normal());
    d_ *= 0.4f / std::sqrt(static_cast<float>(latent));
  }
  int latent_size() const override { return static_cast<int>(b_.size()); }
  int decoded_points() const override { return static_cast<int>(d_.rows() / 3); }
  Encoded encode(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud) const override {
    Encoded out{Eigen::VectorXf(b_.size()), Eigen::VectorXi(b_.size())};
    for (Eigen::Index c = 0; c < b_.size(); ++c) {
      const Eigen::VectorXf value = ((w_.row(c) * cloud).array() + b_[c]).sin().transpose();
      out.latent[c] = value.maxCoeff(&out.critical[c]);
    }
    return out;
  }
  Eigen::Matrix<float, Eigen::Dynamic, 6> pose_jacobian(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud,
                                                        const Encoded& e) const override {
    Eigen::Matrix<float, Eigen::Dynamic, 6> j(b_.size(), 6);
    for (Eigen::Index c = 0; c < b_.size(); ++c) {
      const Eigen::Vector3f x = cloud.col(e.critical[c]), g = slope(c, x);
      j.row(c) << x.cross(g).transpose(), g.transpose();
    }
    return j;
  }
  Eigen::Matrix3Xf point_gradient(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud, const Encoded& e,
                                  const Eigen::VectorXf& g) const override {
    Eigen::Matrix3Xf out = Eigen::Matrix3Xf::Zero(3, cloud.cols());
    for (Eigen::Index c = 0; c < b_.size(); ++c)
      out.col(e.critical[c]) += g[c] * slope(c, cloud.col(e.critical[c]));
    return out;
  }
  Eigen::Matrix3Xf decode(const Eigen::VectorXf& z) const override {
    const Eigen::VectorXf flat = d_ * z;
    return Eigen::Map<const Eigen::Matrix3Xf>(flat.data(), 3, decoded_points());
  }
  Eigen::VectorXf decode_gradient(const Eigen::VectorXf&, const Eigen::Matrix3Xf& g) const override {
    return d_.transpose() * Eigen::Map<const Eigen::VectorXf>(g.data(), g.size());
  }

 private:
  Eigen::Vector3f slope(Eigen::Index c, const Eigen::Vector3f& x) const {
    return std::cos(w_.row(c).dot(x) + b_[c]) * w_.row(c).transpose();
  }
  Eigen::MatrixXf w_;
  Eigen::VectorXf b_;
  Eigen::MatrixXf d_;
};

inline std::unique_ptr<Autoencoder> shipped() {
  return make_pointnet(read_weights(POLAR_SOURCE_DIR "/datasets/weights/polar_autoencoder_1.h5").weights);
}

inline View view_of(const Eigen::Matrix3Xf& points, float lateral, float axial) {
  View view;
  view.points = points;
  for (Eigen::Index j = 0; j < points.cols(); ++j)
    view.covariance.push_back(axial_covariance(lateral * lateral, axial * axial));
  return view;
}

struct Posed {
  Views views;
  std::vector<Pose> view_from_structure;
};

/// `count` noisy views of the bars, anywhere in SO(3) (planar: turned about z), each of `points`.
inline Posed posed_views(int count, int points, float lateral, float axial, std::uint64_t seed,
                         bool planar = false) {
  Posed out;
  out.views.planar = planar;
  for (int i = 0; i < count; ++i) {
    KeyedRandom random(seed, static_cast<std::uint64_t>(i), 3);
    Eigen::Matrix3Xf cloud = three_bars(points, seed * 1000 + static_cast<std::uint64_t>(i));
    if (planar) cloud.row(2).setZero();
    Pose pose;
    pose.rotation = planar ? so3_exp({0, 0, 6.28 * random.uniform()}) : random.rotation();
    pose.translation = 0.05 * random.direction();
    if (planar) pose.translation.z() = 0;
    for (Eigen::Index j = 0; j < cloud.cols(); ++j) {
      const double a = random.normal(), b = random.normal(), c = planar ? 0.0 : random.normal();
      cloud.col(j) = (pose * cloud.col(j).cast<double>()).cast<float>() +
                     Eigen::Vector3f(lateral * static_cast<float>(a), lateral * static_cast<float>(b),
                                     axial * static_cast<float>(c));
    }
    out.views.view.push_back(view_of(cloud, lateral, axial));
    out.views.normalisation.centre_nm.push_back(Eigen::Vector3d::Zero());
    out.view_from_structure.push_back(pose);
  }
  return out;
}

}  // namespace polar::fixture
