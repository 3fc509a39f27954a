#include "polar/results/vtkhdf.hpp"

#include <cmath>
#include <numeric>
#include <set>

#include "heading.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/h5/file.hpp"

namespace polar {

namespace {
using smlm::h5::File;
constexpr std::uint8_t kVertexCell = 1;  // VTK_VERTEX

void write_root(File& file, const char* type) {
  file.make_group("/VTKHDF");
  file.write_attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.write_string_attribute("/VTKHDF", "Type", type);
}

// A column's name as an HDF5 link: "/" would make a group; names that meet are numbered.
std::string link_name(std::string name, std::set<std::string>& used) {
  for (char& c : name)
    if (c == '/') c = '_';
  if (name.empty() || name == ".") name = "column";
  std::string unique = name;
  for (int n = 2; !used.insert(unique).second; ++n) unique = name + "_" + std::to_string(n);
  return "/VTKHDF/PointData/" + unique;
}

void write_point_data(File& file, const smlm::LocalisationTable& table) {
  std::set<std::string> used;
  const std::size_t n = table.size();
  file.make_group("/VTKHDF/PointData");
  std::vector<float> sigma(n), covariance;
  const char* names[] = {"sigma_x_nm", "sigma_y_nm", "sigma_z_nm"};
  const std::size_t diagonal[] = {0, 3, 5};
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < n; ++i) sigma[i] = std::sqrt(table.covariance_nm2[i][diagonal[axis]]);
    file.write(link_name(names[axis], used), sigma);
  }
  covariance.reserve(6 * n);
  for (const smlm::Covariance& c : table.covariance_nm2)
    covariance.insert(covariance.end(), c.begin(), c.end());
  file.write(link_name("covariance_xx_xy_xz_yy_yz_zz_nm2", used), covariance, {n, 6});
  file.write(link_name("particle", used),
             std::vector<std::int32_t>(table.particle.begin(), table.particle.end()));
  file.write(link_name("source_file", used),
             std::vector<std::int32_t>(table.source_file.begin(), table.source_file.end()));
  file.write(link_name("source_row", used),
             std::vector<std::int64_t>(table.source_row.begin(), table.source_row.end()));
  for (const smlm::ExtraColumn& c : table.extra) file.write(link_name(results::heading(c), used), c.values);
}

void write_density(File& file, const std::string& name, const Volume& volume) {
  file.write(name, volume.density, {volume.size[2], volume.size[1], volume.size[0]});
  constexpr double kMicrometresPerNanometre = 1e-3;
  file.write_attribute(name, "element_size_um",
                       std::vector<float>(3, static_cast<float>(volume.voxel_nm * kMicrometresPerNanometre)));
  file.write_string_attribute(name, "unit",
                              volume.planar ? "localisations per nm^2" : "localisations per nm^3");
}
}  // namespace

void write_points_vtkhdf(const std::string& path, const smlm::LocalisationTable& table) {
  smlm::AtomicFile atomic(path);
  File file = File::create(atomic);
  write_root(file, "UnstructuredGrid");
  const std::size_t n = table.size();
  const auto count = static_cast<std::int64_t>(n);
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    file.write(std::string("/VTKHDF/") + name, std::vector<std::int64_t>{count});
  std::vector<double> points;
  points.reserve(3 * n);
  for (const auto& x : table.position_nm) points.insert(points.end(), x.begin(), x.end());
  file.write("/VTKHDF/Points", points, {n, 3});
  std::vector<std::int64_t> index(n + 1);
  std::iota(index.begin(), index.end(), std::int64_t{0});
  file.write("/VTKHDF/Offsets", index);
  index.pop_back();
  file.write("/VTKHDF/Connectivity", index);
  file.write("/VTKHDF/Types", std::vector<std::uint8_t>(n, kVertexCell));
  write_point_data(file, table);
  file.close();
  atomic.commit();
}

void write_volume_vtkhdf(const std::string& path, const Volume& volume,
                         const std::vector<ChannelVolume>& channels) {
  smlm::AtomicFile atomic(path);
  File file = File::create(atomic);
  write_root(file, "ImageData");
  std::vector<std::int64_t> extent;
  for (const std::size_t size : volume.size) {
    extent.push_back(0);
    extent.push_back(static_cast<std::int64_t>(size) - 1);
  }
  file.write_attribute("/VTKHDF", "WholeExtent", extent);
  file.write_attribute("/VTKHDF", "Origin",
                       std::vector<double>(volume.origin_nm.begin(), volume.origin_nm.end()));
  file.write_attribute("/VTKHDF", "Spacing", std::vector<double>(3, volume.voxel_nm));
  file.write_attribute("/VTKHDF", "Direction", std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  std::set<std::string> used;
  write_density(file, link_name("density", used), volume);
  for (const ChannelVolume& c : channels) write_density(file, link_name("density_" + c.name, used), c.volume);
  file.close();
  atomic.commit();
}

}  // namespace polar
