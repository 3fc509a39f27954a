#include "fitting/points.hpp"

#include <gtest/gtest.h>

#include "support/geometric_models.hpp"

namespace polar::fitting {
namespace {

std::vector<WeightedPoint<double>> points(Shape shape, const std::vector<std::string>& arguments,
                                          const std::vector<std::string>& placement = {}) {
  GeometricModel model = empty_model();
  model.part = {testing::part(shape, arguments, placement, model)};
  const std::vector<double> parameter = {3, 0};
  return points_of(model, counts_for(model, parameter, 1), parameter);
}

double total(const std::vector<WeightedPoint<double>>& all) {
  double sum = 0;
  for (const auto& m : all) sum += m.weight;
  return sum;
}

TEST(Points, LieOnTheirPrimitives) {
  for (const auto& m : points(Shape::ring, {"10"})) EXPECT_NEAR(std::hypot(m.x, m.y), 10, 1e-12);
  for (const auto& m : points(Shape::cylinder, {"5", "8"})) {
    EXPECT_NEAR(std::hypot(m.x, m.y), 5, 1e-12);
    EXPECT_LE(std::abs(m.z), 4);
  }
  // A cap of 60 degrees on a sphere of 20: half of the height of its hemisphere, pole at the origin.
  double lowest = 0;
  for (const auto& m : points(Shape::cap, {"20", "60"})) {
    EXPECT_NEAR(std::hypot(m.x, m.y, m.z + 20), 20, 1e-9);
    lowest = std::min(lowest, m.z);
  }
  EXPECT_NEAR(lowest, -10, 0.1);
  for (const auto& m : points(Shape::disc, {"6"})) EXPECT_LE(std::hypot(m.x, m.y), 6);
  EXPECT_EQ(points(Shape::point, {}).size(), 1u);
  EXPECT_NEAR(points(Shape::line, {"10"}).back().z, 5, 1);
}

TEST(Points, WeighOneTogetherAndAreDense) {
  for (const auto& all : {points(Shape::ring, {"10"}), points(Shape::cap, {"20", "60"})})
    EXPECT_NEAR(total(all), 1, 1e-12);
  EXPECT_GE(points(Shape::ring, {"10"}).size(), 62u);  // 2 pi 10 at most 1 apart
}

TEST(Points, ArePlaced) {
  const auto m = points(Shape::point, {}, {"1", "2", "3", "0", "0"})[0];
  EXPECT_DOUBLE_EQ(m.x, 1);
  EXPECT_DOUBLE_EQ(m.z, 3);
  // Tilted by 90 degrees about y, z turns to x; then a quarter turn about z takes it to y.
  const auto line = points(Shape::line, {"10"}, {"0", "0", "0", "90", "90"});
  EXPECT_NEAR(line.back().y, 5, 1);
  EXPECT_NEAR(line.back().x, 0, 1e-12);
}

}  // namespace
}  // namespace polar::fitting
