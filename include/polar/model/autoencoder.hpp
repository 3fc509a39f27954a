// What the latent registration asks of an autoencoder (paper III.B, IV.A): any network that gives these
// five functions can take the place of the one that ships.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

/// A cloud's place in the latent space.
struct Encoded {
  Eigen::VectorXf latent;    // latent_size()
  Eigen::VectorXi critical;  // for each latent entry the point that set it (-1: no single point did)
};

/// Clouds are 3 x n, centred, with a largest radius of about 1. Every function is const, free of shared state
/// and serial, so that callers can run as many as they have threads.
class Autoencoder {
 public:
  virtual ~Autoencoder() = default;

  virtual int latent_size() const = 0;
  virtual int decoded_points() const = 0;

  /// z = E(X) for n >= 1 points, in any order. Throws smlm::Error (input) for an empty cloud and (numerical)
  /// where a coordinate is not finite.
  virtual Encoded encode(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud) const = 0;

  /// dz / d(w, v) at w = v = 0, latent_size() x 6, for the left perturbation x -> exp([w]_x) x + v of every
  /// point; `encoded` is encode(cloud).
  virtual Eigen::Matrix<float, Eigen::Dynamic, 6> pose_jacobian(
      const Eigen::Ref<const Eigen::Matrix3Xf>& cloud, const Encoded& encoded) const = 0;

  /// (dz / dX)^T g, 3 x n: how a scalar with gradient g in z changes with every point.
  virtual Eigen::Matrix3Xf point_gradient(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud,
                                          const Encoded& encoded, const Eigen::VectorXf& g) const = 0;

  /// D(z), 3 x decoded_points().
  virtual Eigen::Matrix3Xf decode(const Eigen::VectorXf& latent) const = 0;

  /// (dD / dz)^T G for G = dL / dD(z), 3 x decoded_points(): the gradient of L in z.
  virtual Eigen::VectorXf decode_gradient(const Eigen::VectorXf& latent, const Eigen::Matrix3Xf& g) const = 0;
};

/// encode() of many clouds of any sizes, in parallel over clouds.
std::vector<Encoded> encode_all(const Autoencoder& model, const std::vector<Eigen::Matrix3Xf>& clouds);

}  // namespace polar
