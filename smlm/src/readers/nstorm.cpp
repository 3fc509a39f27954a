// Nikon N-STORM text export: tab-separated, nm. Xc, Yc, Zc are corrected for drift and warp, so they are the
// positions; "Lateral Localization Accuracy" is a standard deviation; an axial one is not written.
#include "../text/text_table.hpp"
#include "readers.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  return header_has(head, {"channel_name", "x", "y", "xc", "yc", "lateral_localization_accuracy"});
}

std::vector<SourceColumn> columns(const TextHeader& header, ReadOptions&) {
  auto columns =
      columns_by_role(header.cells, {{"xc", Quantity::x, "nm"},
                                     {"yc", Quantity::y, "nm"},
                                     {"zc", Quantity::z, "nm"},
                                     {"lateral_localization_accuracy", Quantity::sigma_lateral, "nm"},
                                     {"frame", Quantity::frame},
                                     {"photons", Quantity::photons},
                                     {"bg", Quantity::background}});
  for (SourceColumn& column : columns) column.text = column.name == "Channel Name";  // "647" or "Z Rejected"
  return columns;
}

}  // namespace

const TableReader nstorm{"nstorm", "Nikon N-STORM (.txt)", recognises, read_with_columns<columns>};

}  // namespace smlm::readers
