#include "model/kernel_table.hpp"

#include "polar/core/isa.hpp"

namespace polar::kernel {

const Table& active_table() {
#if defined(__x86_64__)
  switch (active_isa()) {
    case Isa::avx512:
      return avx512_table();
    case Isa::avx2:
      return avx2_table();
    case Isa::portable:
      break;
  }
#endif
  return portable_table();
}

}  // namespace polar::kernel
