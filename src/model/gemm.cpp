#include "model/gemm.hpp"

#include <algorithm>
#include <cstddef>

#include "model/kernel_table.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {
using kernel::kPanel;

std::size_t size(long n) { return static_cast<std::size_t>(n); }

void pack_panel(int k, int columns, StridedMatrix b, float* out) {
  for (int i = 0; i < k; ++i, out += kPanel) {
    const float* row = b.data + i * b.row_stride;
    for (int j = 0; j < columns; ++j) out[j] = row[j * b.column_stride];
    std::fill(out + columns, out + kPanel, 0.0f);
  }
}

std::vector<float> pack_rows(int m, int k, StridedMatrix a, int tile_rows) {
  const int tiles = (m + tile_rows - 1) / tile_rows;
  std::vector<float> packed(size(tiles) * size(tile_rows) * size(k), 0.0f);
  for (int r = 0; r < m; ++r) {
    float* out = packed.data() + long{r / tile_rows} * tile_rows * k + r % tile_rows;
    const float* row = a.data + r * a.row_stride;
    for (int i = 0; i < k; ++i) out[long{i} * tile_rows] = row[i * a.column_stride];
  }
  return packed;
}
}  // namespace

std::vector<float> pack_panels(int k, int n, StridedMatrix b) {
  const int panels = (n + kPanel - 1) / kPanel;
  std::vector<float> packed(size(panels) * size(k) * kPanel);
  for (int p = 0; p < panels; ++p) {
    const int first = p * kPanel;
    pack_panel(k, std::min(kPanel, n - first),
               {b.data + first * b.column_stride, b.row_stride, b.column_stride},
               packed.data() + long{p} * k * kPanel);
  }
  return packed;
}

void gemm(int m, int n, int k, StridedMatrix a, StridedMatrix b, float* c, long ldc, bool accumulate,
          Threads threads) {
  const kernel::Table& table = kernel::active_table();
  const std::vector<float> rows = pack_rows(m, k, a, table.tile_rows);
  const std::size_t panels = size((n + kPanel - 1) / kPanel);
  const auto panel = [&](std::size_t p) {
    thread_local std::vector<float> packed;
    packed.resize(size(k) * kPanel);
    const int first = static_cast<int>(p) * kPanel, columns = std::min(kPanel, n - first);
    pack_panel(k, columns, {b.data + first * b.column_stride, b.row_stride, b.column_stride}, packed.data());
    table.gemm_panel(m, columns, k, rows.data(), packed.data(), c + first, ldc, accumulate);
  };
  if (threads == Threads::parallel)
    parallel_for(panels, panel);
  else
    for (std::size_t p = 0; p < panels; ++p) panel(p);
}

}  // namespace polar
