// The readers, one file each; table_readers() puts them in order.
#pragma once

#include "smlm/table_reader.hpp"

namespace smlm::readers {

extern const TableReader picasso;
extern const TableReader picasso_pandas;
extern const TableReader smap;
extern const TableReader decode;
extern const TableReader particle_cells;
extern const TableReader smlm_zip;
extern const TableReader minflux;
extern const TableReader minflux_json;
extern const TableReader minflux_mat;
extern const TableReader rapidstorm;
extern const TableReader elyra;
extern const TableReader nstorm;
extern const TableReader oni;
extern const TableReader zola;
extern const TableReader thunderstorm;
extern const TableReader csv;  // whatever else is a text table: last

}  // namespace smlm::readers
