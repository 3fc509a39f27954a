#include "model/kernel_table.hpp"

#include "polar/core/isa.hpp"

namespace polar::kernel {

const Table& active_table() {
#if defined(__x86_64__)
  return of_active_isa(portable_table, avx2_table, avx512_table);
#else
  return portable_table();
#endif
}

}  // namespace polar::kernel
