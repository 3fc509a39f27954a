// ONI Nanoimager CSV: nm beside pixels (the nm columns are read), precisions as standard deviations of x and
// y, none of z; older versions write no precision at all.
#include "../text/text_table.hpp"
#include "readers.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  if (head.bytes.find("X (nm)") == std::string::npos) return false;
  return header_has(head, {"channel", "frame", "x", "y", "photons", "background"});
}

std::vector<SourceColumn> columns(const TextHeader& header, ReadOptions&) {
  return nm_columns_by_role(header.cells, {{"x", Quantity::x},
                                           {"y", Quantity::y},
                                           {"z", Quantity::z},
                                           {"x_precision", Quantity::sigma_x},
                                           {"y_precision", Quantity::sigma_y},
                                           {"z_precision", Quantity::sigma_z},
                                           {"frame", Quantity::frame},
                                           {"photons", Quantity::photons},
                                           {"background", Quantity::background}});
}

}  // namespace

const TableReader oni{"oni", "ONI Nanoimager (.csv)", recognises, read_with_columns<columns>};

}  // namespace smlm::readers
