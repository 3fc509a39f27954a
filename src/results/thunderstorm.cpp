#include "polar/results/thunderstorm.hpp"

#include <algorithm>
#include <cmath>

#include "csv_line.hpp"
#include "known_column.hpp"

namespace polar {

namespace {
using results::value_or;
using smlm::ExtraColumn;

// Columns of the input that ThunderSTORM has a name for.
struct Known {
  const ExtraColumn *frame, *intensity, *offset, *width_1_nm, *width_2_nm;
};

Known known_columns(const smlm::LocalisationTable& table) {
  const ExtraColumn* width = results::find_length_nm(table, "sigma");
  const ExtraColumn* first = results::find_length_nm(table, "sigma1");
  const ExtraColumn* second = results::find_length_nm(table, "sigma2");
  return {smlm::find_column(table, smlm::Quantity::frame), smlm::find_column(table, smlm::Quantity::photons),
          smlm::find_column(table, smlm::Quantity::background), first ? first : width,
          second ? second : width};
}

const char* header(bool planar) {
  return planar ? "\"id\",\"frame\",\"x [nm]\",\"y [nm]\",\"sigma [nm]\",\"intensity [photon]\","
                  "\"offset [photon]\",\"bkgstd [photon]\",\"uncertainty_xy [nm]\",\"particle\"\n"
                : "\"id\",\"frame\",\"x [nm]\",\"y [nm]\",\"z [nm]\",\"sigma1 [nm]\",\"sigma2 [nm]\","
                  "\"intensity [photon]\",\"offset [photon]\",\"bkgstd [photon]\",\"uncertainty_xy [nm]\","
                  "\"uncertainty_z [nm]\",\"particle\"\n";
}

// ThunderSTORM counts frames from 1; tables that count from 0 show it by having a frame 0.
double first_frame_shift(const ExtraColumn* frame) {
  if (!frame) return 0;
  return std::find(frame->values.begin(), frame->values.end(), 0.0) != frame->values.end() ? 1 : 0;
}
}  // namespace

std::string format_thunderstorm_csv(const smlm::LocalisationTable& table) {
  const Known known = known_columns(table);
  const double shift = first_frame_shift(known.frame);
  std::string text = header(table.planar);
  const auto add = [&](const std::string& field) { text += field + ","; };
  for (std::size_t row = 0; row < table.size(); ++row) {
    const smlm::Covariance& c = table.covariance_nm2[row];
    add(std::to_string(row + 1));
    add(results::csv_number(value_or(known.frame, row, 1 - shift) + shift));
    for (std::size_t axis = 0; axis < (table.planar ? 2u : 3u); ++axis)
      add(results::csv_length(table.position_nm[row][axis]));
    add(results::csv_length(value_or(known.width_1_nm, row, 0)));
    if (!table.planar) add(results::csv_length(value_or(known.width_2_nm, row, 0)));
    add(results::csv_number(value_or(known.intensity, row, 0)));
    add(results::csv_number(value_or(known.offset, row, 0)));
    add("0");  // bkgstd: no other program's table tells it
    add(results::csv_length(std::sqrt((double(c[0]) + double(c[3])) / 2)));
    if (!table.planar) add(results::csv_length(std::sqrt(double(c[5]))));
    const std::int64_t particle = table.particle[row];
    if (particle >= 0) text += results::csv_field(table.particle_names[static_cast<std::size_t>(particle)]);
    text += "\n";
  }
  return text;
}

}  // namespace polar
