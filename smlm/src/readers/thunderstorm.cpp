// ThunderSTORM's CSV export: "name [unit]" in every header cell; names as in its MoleculeDescriptor and
// PSFModel. `sigma` is the width of the PSF, `uncertainty*` (older releases: `uncertainty`) the standard
// deviation of the position; an infinite uncertainty_z means that none was found.
#include <algorithm>
#include <array>

#include "../text/text_table.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

constexpr std::array<std::string_view, 8> widths{"sigma",  "sigma1", "sigma2", "sigma3",
                                                 "sigma4", "angle",  "z_rel",  "chi2"};

bool recognises(const FileHead& head) {
  if (head.hdf5) return false;
  try {
    const TextHeader header = header_of(head.bytes);
    const auto has = [&](std::string_view start) {
      return std::any_of(header.cells.begin(), header.cells.end(),
                         [&](const std::string& cell) { return cell.rfind(start, 0) == 0; });
    };
    // The words that only ThunderSTORM and its imitators combine.
    return header.delimiter == ',' && has("x [") && has("y [") &&
           (has("uncertainty") || has("sigma [") || has("sigma1 [") || has("bkgstd") || has("intensity ["));
  } catch (const Error&) {
    return false;
  }
}

std::vector<SourceColumn> columns(const TextHeader& header, ReadOptions&) {
  std::vector<SourceColumn> result;
  for (const std::string& cell : header.cells) {
    const Heading heading = parse_heading(cell);
    SourceColumn column{cell, heading.unit};
    if (std::find(widths.begin(), widths.end(), heading.name) != widths.end())
      column.quantity = Quantity::other;
    result.push_back(column);
  }
  return result;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  TextFormat format;
  format.columns = columns;
  format.reject_infinite_sigma_z = true;
  return read_text_table(path, options, format);
}

}  // namespace

const TableReader thunderstorm{"thunderstorm", "ThunderSTORM (CSV), and exports in its style", recognises,
                               read};

}  // namespace smlm::readers
