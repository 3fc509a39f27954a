#include "polar/model/score.hpp"

#include "model/procedural.hpp"
#include "polar/core/parallel.hpp"
#include "polar/model/chamfer.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kStage = 0x73636f72u;  // of the keyed random numbers
constexpr int kCleanPoints = 1024;
constexpr std::size_t kShapesPerBlock = 8;
}  // namespace

std::vector<NamedConditions> standard_conditions() {
  return {{"clean", {}},
          {"isotropic .05", {{0.05, 0.05, 0.05}, kCleanPoints}},
          {"anisotropic .02 .02 .1", {{0.02, 0.02, 0.1}, kCleanPoints}},
          {"200 points", {Eigen::Vector3d::Zero(), 200}}};
}

double mean_chamfer(const Autoencoder& model, const ShapeSet& shapes, const ScoreConditions& conditions,
                    std::uint64_t seed) {
  const double sum =
      ordered_sum(shapes.size(), kShapesPerBlock, 0.0, [&](std::size_t begin, std::size_t end) {
        double block = 0;
        for (std::size_t i = begin; i < end; ++i) {
          KeyedRandom random(seed, i, kStage);
          Eigen::Matrix3Xf clean = shapes.sample(i, kCleanPoints, random);
          centre_and_normalise(clean);
          clean = (random.rotation().cast<float>() * clean).eval();
          Eigen::Matrix3Xf spoilt = clean.leftCols(conditions.points);  // already in random order
          for (Eigen::Index p = 0; p < spoilt.cols(); ++p)
            for (int a = 0; a < 3; ++a)
              spoilt(a, p) += static_cast<float>(conditions.sigma[a] * random.normal());
          block += chamfer(model.decode(model.encode(spoilt).latent), clean).sum();
        }
        return block;
      });
  return sum / static_cast<double>(shapes.size());
}

}  // namespace polar
