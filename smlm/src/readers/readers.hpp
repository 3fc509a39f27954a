// The readers, one file each; table_readers() puts them in order.
#pragma once

#include "smlm/table_reader.hpp"

namespace smlm::readers {

extern const TableReader thunderstorm;
extern const TableReader picasso;
extern const TableReader csv;  // whatever else is a text table: last

}  // namespace smlm::readers
