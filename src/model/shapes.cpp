#include "polar/model/shapes.hpp"

#include <numeric>

#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/isolation.hpp"

namespace polar {

std::uint64_t ShapeSet::size() const {
  std::uint64_t n = 0;
  for (const File& file : files) n += file.shapes;
  return n;
}

Eigen::Matrix3Xf ShapeSet::sample(std::uint64_t index, int points, KeyedRandom& random) const {
  auto file = files.begin();
  while (index >= file->shapes) index -= (file++)->shapes;
  const std::uint64_t n = file->points_per_shape;
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  Eigen::Matrix3Xf cloud(3, points);
  for (Eigen::Index i = 0; i < points; ++i) {  // the first steps of a Fisher-Yates shuffle
    const auto at = static_cast<std::uint64_t>(i);
    std::swap(order[at], order[at + random.below(n - at)]);
    const std::int16_t* p = file->points.data() + 3 * (index * n + order[at]);
    cloud.col(i) = static_cast<float>(file->scale) * Eigen::Vector3f(p[0], p[1], p[2]);
  }
  return cloud;
}

namespace {

ShapeSet::File read_file(const std::string& path, int min_points) {
  const smlm::h5::File h5 = smlm::h5::File::open(path);
  const auto fail = [&](const std::string& what) {
    throw smlm::Error(smlm::Fault::input, path + ": /points", what,
                      "a shape file holds `points`, int16 (shape, point, 3), with the attribute `scale`");
  };
  if (!h5.exists("/points")) fail("is missing");
  const smlm::h5::DatasetInfo info = h5.info("/points");
  if (info.kind != smlm::h5::Kind::integer || info.shape.size() != 3 || info.shape[2] != 3)
    fail("has another type or shape");
  if (info.shape[1] < static_cast<std::uint64_t>(min_points))
    fail("has " + std::to_string(info.shape[1]) + " points a shape, at least " + std::to_string(min_points) +
         " are needed");
  if (!h5.has_attribute("/points", "scale")) fail("has no attribute `scale`");
  const auto scale = h5.read_attribute<double>("/points", "scale");
  if (scale.size() != 1 || !(scale[0] > 0)) fail("has a `scale` that is no positive number");
  return {path, info.shape[0], info.shape[1], scale[0], h5.read<std::int16_t>("/points")};
}

}  // namespace

ShapeSet read_shapes(const std::vector<std::string>& paths, int min_points) {
  ShapeSet set;
  for (const std::string& path : paths)
    set.files.push_back(smlm::read_isolated(path, [&] { return read_file(path, min_points); }));
  return set;
}

}  // namespace polar
