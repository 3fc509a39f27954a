// Zeiss ELYRA (ZEN): tab-separated, units in the header, CRLF, and behind a blank line or a NUL byte a footer
// about voxels and regions. "Precision" is the lateral standard deviation; an axial one is not written.
#include "../text/text_table.hpp"
#include "readers.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  return header_has(head, {"first_frame", "position_x", "position_y", "precision"});
}

std::vector<SourceColumn> columns(const TextHeader& header, ReadOptions&) {
  return columns_by_role(header.cells, {{"position_x", Quantity::x},
                                        {"position_y", Quantity::y},
                                        {"position_z", Quantity::z},
                                        {"precision", Quantity::sigma_lateral},
                                        {"precision_z", Quantity::sigma_z},
                                        {"first_frame", Quantity::frame},
                                        {"number_photons", Quantity::photons},
                                        {"background_variance", Quantity::background}});
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  TextFormat format;
  format.columns = columns;
  format.footer = true;
  return read_text_table(path, options, format);
}

}  // namespace

const TableReader elyra{"elyra", "Zeiss ELYRA / ZEN (.txt)", recognises, read};

}  // namespace smlm::readers
