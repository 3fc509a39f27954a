// ZOLA-3D CSV: positions and Cramer-Rao bounds (standard deviations) in pixels and in nm; z only in nm.
#include "../text/text_table.hpp"
#include "readers.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  return header_has(head, {"frame", "x", "y", "z", "crlb_xnm", "crlb_ynm"});
}

std::vector<SourceColumn> columns(const TextHeader& header, ReadOptions&) {
  return nm_columns_by_role(header.cells, {{"x", Quantity::x},
                                           {"y", Quantity::y},
                                           {"z", Quantity::z},
                                           {"crlb_xnm", Quantity::sigma_x, "nm"},
                                           {"crlb_ynm", Quantity::sigma_y, "nm"},
                                           {"crlb_z", Quantity::sigma_z, "nm"},
                                           {"frame", Quantity::frame},
                                           {"intensity", Quantity::photons},
                                           {"background", Quantity::background}});
}

}  // namespace

const TableReader zola{"zola", "ZOLA-3D (.csv)", recognises, read_with_columns<columns>};

}  // namespace smlm::readers
