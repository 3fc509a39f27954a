#include "polar/latent/loss.hpp"

#include <Eigen/Geometry>

#include "mask.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {

// The template under one pose, draw by draw.
struct Simulated {
  Eigen::Matrix3Xf turned;  // R p, about the template's origin
  Eigen::Matrix3Xf cloud;   // R p + t + noise
  std::vector<int> source;  // decoded point of each draw
};

Simulated keep(const Simulated& all, const std::vector<int>& kept) {
  Simulated out{columns(all.turned, kept), columns(all.cloud, kept), {}};
  for (const int k : kept) out.source.push_back(all.source[static_cast<std::size_t>(k)]);
  return out;
}

Simulated drawn(const LatentView& view, const Eigen::Matrix3Xf& template_points, const Pose& pose) {
  Simulated s{{}, {}, view.source};
  s.turned = pose.rotation.cast<float>() * columns(template_points, view.source);
  s.cloud = (s.turned + view.noise).colwise() + pose.translation.cast<float>();
  return s;
}

Simulated masked(const LatentView& view, Simulated all) {
  if (view.visibility >= 1) return all;
  return keep(all, nearest_share(nearest_distances(all.cloud, view.points), view.visibility));  // M^v
}

Eigen::VectorXf target(const Autoencoder& model, const LatentView& view, const Simulated& all) {
  if (view.outlier_fraction <= 0) return view.encoded;
  const std::vector<int> kept =
      nearest_share(nearest_distances(view.points, all.cloud), 1 - view.outlier_fraction);  // M^o
  return model.encode(columns(view.points, kept)).latent;
}

// The noise does not turn with the template, so the network's own derivative for a turn of the whole cloud
// is replaced by (R p) x g, g the derivative for a shift; about the template's origin.
Eigen::Matrix<float, Eigen::Dynamic, 6> pose_derivative(const Autoencoder& model, const Simulated& s,
                                                        const Encoded& encoded) {
  Eigen::Matrix<float, Eigen::Dynamic, 6> jacobian = model.pose_jacobian(s.cloud, encoded);
  for (Eigen::Index c = 0; c < jacobian.rows(); ++c) {
    if (encoded.critical[c] < 0) continue;
    const Eigen::Vector3f turned = s.turned.col(encoded.critical[c]);
    const Eigen::Vector3f g = jacobian.row(c).tail<3>().transpose();
    jacobian.row(c).head<3>() = turned.cross(g).transpose();
  }
  return jacobian;
}

}  // namespace

Pose stepped(const Pose& pose, const Eigen::Matrix<double, 6, 1>& delta) {
  return {so3_exp(delta.head<3>()) * pose.rotation, pose.translation + delta.tail<3>()};
}

LossTerm view_loss(const Autoencoder& model, const LatentView& view, const Eigen::Matrix3Xf& template_points,
                   const Pose& pose, Derive derive) {
  LossTerm term;
  if (derive == Derive::pose_and_template)
    term.template_gradient = Eigen::Matrix3Xf::Zero(3, template_points.cols());
  if (view.empty()) return term;
  const Simulated all = drawn(view, template_points, pose);
  const Eigen::VectorXf wanted = target(model, view, all);
  const Simulated s = masked(view, all);
  const Encoded encoded = model.encode(s.cloud);
  term.residual = encoded.latent - wanted;
  term.loss = term.residual.cast<double>().squaredNorm();
  if (derive == Derive::nothing) return term;
  term.jacobian = pose_derivative(model, s, encoded);
  if (derive == Derive::pose) return term;
  const Eigen::Matrix3Xf gradient =
      pose.rotation.transpose().cast<float>() * model.point_gradient(s.cloud, encoded, 2 * term.residual);
  for (std::size_t k = 0; k < s.source.size(); ++k)
    term.template_gradient.col(s.source[k]) += gradient.col(static_cast<Eigen::Index>(k));
  return term;
}

Eigen::Matrix3Xf simulated_view(const LatentView& view, const Eigen::Matrix3Xf& template_points,
                                const Pose& pose) {
  return masked(view, drawn(view, template_points, pose)).cloud;
}

}  // namespace polar
