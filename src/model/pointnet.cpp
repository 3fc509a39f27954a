#include "polar/model/pointnet.hpp"

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "model/encoder_panels.hpp"
#include "polar/core/parallel.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using kernel::kLatent;

constexpr Eigen::Index kShapes[6][2] = {{kernel::kHidden1, 3},       {kernel::kHidden2, kernel::kHidden1},
                                        {kLatent, kernel::kHidden2}, {kLatent, kLatent},
                                        {kLatent, kLatent},          {3 * kLatent, kLatent}};

std::string shape(Eigen::Index rows, Eigen::Index columns, Eigen::Index biases) {
  return std::to_string(rows) + " x " + std::to_string(columns) + " with " + std::to_string(biases) +
         " biases";
}
}  // namespace

void require_network(const PointNetWeights& weights, const std::string& source) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Linear& layer = i < 3 ? weights.encoder[i] : weights.decoder[i - 3];
    const std::string where = (source.empty() ? "" : source + ": ") + (i < 3 ? "encoder" : "decoder") +
                              " layer " + std::to_string(i % 3);
    const Eigen::Index out = kShapes[i][0], in = kShapes[i][1];
    if (layer.weight.rows() != out || layer.weight.cols() != in || layer.bias.size() != out)
      throw smlm::Error(smlm::Fault::input, where,
                        "is " + shape(layer.weight.rows(), layer.weight.cols(), layer.bias.size()) +
                            ", expected " + shape(out, in, out),
                        "use weights written by `polar train`");
    if (!layer.weight.allFinite() || !layer.bias.allFinite())
      throw smlm::Error(smlm::Fault::input, where, "holds a value that is not finite",
                        "the training diverged or the file is damaged; train again or fetch it again");
  }
}

namespace {
class PointNet final : public Autoencoder {
 public:
  explicit PointNet(const PointNetWeights& weights) : weights_(weights), encoder_(weights.encoder) {}

  int latent_size() const override { return kLatent; }
  int decoded_points() const override { return kLatent; }

  Encoded encode(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud) const override {
    if (cloud.cols() == 0)
      throw smlm::Error(smlm::Fault::input, "autoencoder", "a cloud without points has no latent vector");
    if (!cloud.allFinite())
      throw smlm::Error(smlm::Fault::numerical, "autoencoder", "a coordinate of the cloud is not finite");
    return encoder_.encode(cloud);
  }

  Eigen::Matrix<float, Eigen::Dynamic, 6> pose_jacobian(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud,
                                                        const Encoded& encoded) const override {
    const auto point = critical_jacobian(weights_, cloud, encoded);
    Eigen::Matrix<float, Eigen::Dynamic, 6> jacobian(kLatent, 6);
    for (Eigen::Index c = 0; c < kLatent; ++c) {
      // g . (w x x) = w . (x x g)
      const Eigen::Vector3f x = cloud.col(encoded.critical[c]), g = point.row(c).transpose();
      jacobian.row(c) << x.cross(g).transpose(), g.transpose();
    }
    return jacobian;
  }

  Eigen::Matrix3Xf point_gradient(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud, const Encoded& encoded,
                                  const Eigen::VectorXf& g) const override {
    const auto point = critical_jacobian(weights_, cloud, encoded);
    Eigen::Matrix3Xf gradient = Eigen::Matrix3Xf::Zero(3, cloud.cols());
    for (Eigen::Index c = 0; c < kLatent; ++c)
      gradient.col(encoded.critical[c]) += g[c] * point.row(c).transpose();
    return gradient;
  }

  Eigen::Matrix3Xf decode(const Eigen::VectorXf& latent) const override {
    const Eigen::VectorXf out = affine(2, affine(1, affine(0, latent).cwiseMax(0.0f)).cwiseMax(0.0f));
    return Eigen::Map<const Eigen::Matrix3Xf>(out.data(), 3, kLatent);
  }

  Eigen::VectorXf decode_gradient(const Eigen::VectorXf& latent, const Eigen::Matrix3Xf& g) const override {
    const Eigen::VectorXf y1 = affine(0, latent), y2 = affine(1, y1.cwiseMax(0.0f));
    const Eigen::VectorXf g3 =
        weights_.decoder[2].weight.transpose() * Eigen::Map<const Eigen::VectorXf>(g.data(), g.size());
    const Eigen::VectorXf g2 =
        weights_.decoder[1].weight.transpose() * (y2.array() > 0.0f).select(g3, 0.0f).matrix();
    return weights_.decoder[0].weight.transpose() * (y1.array() > 0.0f).select(g2, 0.0f).matrix();
  }

 private:
  Eigen::VectorXf affine(std::size_t layer, const Eigen::VectorXf& x) const {
    return weights_.decoder[layer].weight * x + weights_.decoder[layer].bias;
  }

  PointNetWeights weights_;
  PackedEncoder encoder_;
};
}  // namespace

std::unique_ptr<Autoencoder> make_pointnet(const PointNetWeights& weights) {
  require_network(weights);
  return std::make_unique<PointNet>(weights);
}

std::vector<Encoded> encode_all(const Autoencoder& model, const std::vector<Eigen::Matrix3Xf>& clouds) {
  std::vector<Encoded> out(clouds.size());
  parallel_for(clouds.size(), [&](std::size_t i) { out[i] = model.encode(clouds[i]); });
  return out;
}

}  // namespace polar
