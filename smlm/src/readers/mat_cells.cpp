#include "mat_cells.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "../mat_v5.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

// smlm_datafusion3d's columns of `coords`, counted from 0.
constexpr std::size_t coords_sigma_lateral = 4;
constexpr std::size_t coords_sigma_axial = 9;

[[noreturn]] void fail(const std::string& path, std::size_t cell, const std::string& what) {
  throw Error(Fault::input, path + ": particle " + std::to_string(cell + 1), what,
              "write points (n x 2 or 3) and sigma (n x 1 or 2), or coords");
}

struct Columns {
  std::vector<double> x, y, z, lateral, axial, particle;
};

void append(Columns& all, const Matrix& points, std::size_t axes, const Matrix& sigma, std::size_t lateral,
            std::size_t axial, bool has_axial, double particle) {
  for (std::size_t i = 0; i < points.rows; ++i) {
    all.x.push_back(points(i, 0));
    all.y.push_back(points(i, 1));
    if (axes == 3) all.z.push_back(points(i, 2));
    all.lateral.push_back(sigma(i, lateral));
    if (has_axial) all.axial.push_back(sigma(i, axial));
    all.particle.push_back(particle);
  }
}

// Adds one particle; returns its axes and whether it has an axial sigma, which all must agree on.
std::pair<std::size_t, bool> add(Columns& all, const std::string& path, std::size_t cell,
                                 const MatParticle& particle) {
  const double number = static_cast<double>(cell + 1);
  const Matrix& coords = particle.coords;
  if (!particle.points.values.empty()) {
    const std::size_t axes = particle.points.columns;
    const Matrix& sigma = particle.sigma;
    if (axes != 2 && axes != 3) fail(path, cell, "its points have " + std::to_string(axes) + " columns");
    if (sigma.rows != particle.points.rows || (sigma.columns != 1 && sigma.columns != 2)) {
      fail(path, cell, "its sigma does not fit its points");
    }
    const bool has_axial = axes == 3 && sigma.columns == 2;
    append(all, particle.points, axes, sigma, 0, 1, has_axial, number);
    return {axes, has_axial};
  }
  if (coords.columns == 3) {
    append(all, coords, 2, coords, 2, 0, false, number);
    return {2, false};
  }
  if (coords.columns > coords_sigma_axial) {
    append(all, coords, 3, coords, coords_sigma_lateral, coords_sigma_axial, true, number);
    return {3, true};
  }
  if (coords.columns > coords_sigma_lateral) {
    append(all, coords, 2, coords, coords_sigma_lateral, 0, false, number);
    return {2, false};
  }
  fail(path, cell, "has neither points nor coords");
}

// Which of the two names the variable has is up to the program that wrote it.
const std::string* variable_among(const std::vector<std::string>& names) {
  static const std::array<std::string, 2> known{"particles", "Particles"};
  for (const std::string& name : known) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return &name;
  }
  return nullptr;
}

std::vector<std::string> variables_v73(const h5::File& file) {
  std::vector<std::string> names;
  for (const h5::Entry& entry : file.list("/")) names.push_back(entry.name);
  return names;
}

bool recognises(const FileHead& head) {
  if (head.hdf5) return variable_among(variables_v73(h5::File::open(head.path))) != nullptr;
  return is_mat_v5(head.bytes) && variable_among(mat_v5_variables(head.path)) != nullptr;
}

const std::string& required_variable(const std::string& path, const std::vector<std::string>& names) {
  const std::string* name = variable_among(names);
  if (name == nullptr)
    throw Error(Fault::input, path, "has no variable 'particles'", "save the cell array under that name");
  return *name;
}

std::vector<MatParticle> read_v73(const std::string& path) {
  const h5::File file = h5::File::open(path);
  const std::string variable = "/" + required_variable(path, variables_v73(file));
  // MATLAB stores columns first, so shapes are reversed and the values are column-major already.
  const auto matrix = [&](const std::string& object) {
    Matrix result;
    if (!file.is_dataset(object)) return result;
    const h5::DatasetInfo info = file.info(object);
    if (info.shape.size() != 2) return result;
    result.rows = info.shape[1];
    result.columns = info.shape[0];
    result.values = file.read<double>(object);
    return result;
  };
  std::vector<MatParticle> particles;
  for (const std::string& cell : file.read_references(variable)) {
    MatParticle particle;
    if (file.is_dataset(cell)) {
      particle.coords = matrix(cell);
    } else {
      particle.points = matrix(cell + "/points");
      particle.sigma = matrix(cell + "/sigma");
      particle.coords = matrix(cell + "/coords");
    }
    particles.push_back(std::move(particle));
  }
  return particles;
}

Matrix matrix_of(const MatValue& value) {
  if (value.kind != MatValue::Kind::numbers || value.dims.size() != 2) return {};
  return {value.dims[0], value.dims[1], value.numbers};
}

std::vector<MatParticle> read_v5(const std::string& path) {
  const MatValue variable = read_mat_v5(path, required_variable(path, mat_v5_variables(path)));
  if (variable.kind != MatValue::Kind::cells) {
    throw Error(Fault::input, path, "its 'particles' is not a cell array", "save one cell per particle");
  }
  std::vector<MatParticle> particles;
  for (const MatValue& cell : variable.cells) {
    particles.push_back(
        {matrix_of(cell.field("points")), matrix_of(cell.field("sigma")),
         cell.kind == MatValue::Kind::numbers ? matrix_of(cell) : matrix_of(cell.field("coords"))});
  }
  return particles;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  return build_particle_table(path, h5::File::is_hdf5(path) ? read_v73(path) : read_v5(path), options);
}

}  // namespace

LocalisationTable build_particle_table(const std::string& path, const std::vector<MatParticle>& particles,
                                       const ReadOptions& options) {
  Columns all;
  std::optional<std::pair<std::size_t, bool>> kind;
  for (std::size_t cell = 0; cell < particles.size(); ++cell) {
    const MatParticle& particle = particles[cell];
    if (particle.points.rows == 0 && particle.coords.rows == 0) continue;
    const auto own = add(all, path, cell, particle);
    if (kind && own != *kind) fail(path, cell, "has other columns than the particles before it");
    kind = own;
  }
  if (!kind)
    throw Error(Fault::input, path, "holds no particle with localisations", "is it a set of particles?");
  const Spread spread = options.sigma_kind == "variance" ? Spread::variance : Spread::standard_deviation;
  std::vector<ColumnArray> arrays{{{"x", "", Quantity::x}, std::move(all.x)},
                                  {{"y", "", Quantity::y}, std::move(all.y)},
                                  {{"sigma_xy", "", Quantity::sigma_lateral, spread}, std::move(all.lateral)},
                                  {{"particle", "", Quantity::particle}, std::move(all.particle)}};
  if (kind->first == 3) arrays.push_back({{"z", "", Quantity::z}, std::move(all.z)});
  if (kind->second) arrays.push_back({{"sigma_z", "", Quantity::sigma_z, spread}, std::move(all.axial)});
  LocalisationTable table = build_table(path, path, std::move(arrays), options);
  table.keys_used.insert("sigma_kind");
  if (options.sigma_kind.empty()) {
    table.warnings.emplace_back(
        "files of this kind hold standard deviations or variances and do not say which: standard deviations "
        "are "
        "taken (input.sigma_kind)");
  }
  return table;
}

const TableReader particle_cells{"particle_cells", "smlm_datafusion2d/3d, JRMPC, lmdeconv (.mat)", recognises,
                                 read};

}  // namespace smlm::readers
