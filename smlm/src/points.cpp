#include "smlm/points.hpp"

#include "smlm/table_reader.hpp"

namespace smlm {

Points read_points(const std::string& path, const ReadOptions& options) {
  ReadOptions only = options;
  only.positions_only = true;
  only.particles = "column";
  const FileHead head = read_head(path);
  LocalisationTable table = find_reader(head, only).read(path, only);
  return {std::move(table.position_nm), table.planar, std::move(table.warnings), std::move(table.keys_used)};
}

}  // namespace smlm
