// MINFLUX (abberior) .mat, MATLAB 5: the variables tid, vld, tim, ... (1 x N) and the struct itr, whose
// fields are N x iterations, loc N x iterations x 3 (2 of measurements in the plane). The last iteration is
// the final one.
#include <algorithm>

#include "../mat_v5.hpp"
#include "minflux.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  if (!is_mat_v5(head.bytes)) return false;
  const auto names = mat_v5_variables(head.path);
  return std::count(names.begin(), names.end(), "itr") == 1 &&
         std::count(names.begin(), names.end(), "tid") == 1;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const MatValue iterations = read_mat_v5(path, "itr");
  const MatValue trace = read_mat_v5(path, "tid");
  const auto names = mat_v5_variables(path);
  const MatValue valid =
      std::count(names.begin(), names.end(), "vld") == 1 ? read_mat_v5(path, "vld") : MatValue();
  const MatValue& location = iterations.field("loc");
  const std::size_t n = trace.numbers.size();
  const std::size_t axes = location.dims.empty() ? 0 : location.dims.back();
  const bool fits = location.dims.size() > 1 && location.dims[0] == n && (axes == 2 || axes == 3);
  const bool cube = fits && location.dims.size() == 3 && location.dims[1] > 0;
  const bool flat = fits && location.dims.size() == 2;
  if (location.kind != MatValue::Kind::numbers || (!cube && !flat)) {
    throw Error(Fault::input, path, "is not a MINFLUX table: itr.loc does not fit tid", "export it as .npy");
  }
  const std::size_t count = flat ? 1 : location.dims[1];
  const std::size_t axis_stride = n * count;
  const std::size_t last = n * (count - 1);

  MinfluxRows rows;
  rows.planar = axes == 2;
  std::vector<const MatValue*> kept;
  for (const auto& [name, field] : iterations.fields) {
    if (field.kind != MatValue::Kind::numbers || field.numbers.size() != n * count) continue;
    kept.push_back(&field);
    rows.extra.push_back({{name, "", Quantity::other}, {}});
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (valid.numbers.size() == n && valid.numbers[i] == 0) {
      if (rows.invalid++ == 0) rows.first_invalid = i + 1;
      continue;
    }
    std::array<double, 3> x{};
    for (std::size_t axis = 0; axis < axes; ++axis) x[axis] = location.numbers[axis * axis_stride + last + i];
    rows.location_m.push_back(x);
    rows.trace.push_back(trace.numbers[i]);
    rows.row.push_back(i + 1);
    for (std::size_t e = 0; e < kept.size(); ++e) rows.extra[e].values.push_back(kept[e]->numbers[last + i]);
  }
  return build_minflux_table(path, std::move(rows), options);
}

}  // namespace

const TableReader minflux_mat{"minflux_mat", "MINFLUX / Imspector (.mat)", recognises, read};

}  // namespace smlm::readers
