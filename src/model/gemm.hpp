// Dense single-precision products on the kernels of the active instruction set.
#pragma once

#include <vector>

namespace polar {

/// A matrix seen through strides: element (r, c) at data[r * row_stride + c * column_stride].
struct StridedMatrix {
  const float* data;
  long row_stride, column_stride;
};

inline StridedMatrix row_major(const float* data, long columns) { return {data, columns, 1}; }
inline StridedMatrix transposed(StridedMatrix m) { return {m.data, m.column_stride, m.row_stride}; }

enum class Threads { serial, parallel };

/// C (m x n, row-major, row stride ldc) = A B, or += with `accumulate`. The same bits for any number of
/// threads: one task owns a panel of columns and sums over k in order.
void gemm(int m, int n, int k, StridedMatrix a, StridedMatrix b, float* c, long ldc, bool accumulate,
          Threads threads);

/// Packs a k x n matrix into panels [n / kernel::kPanel][k][kernel::kPanel], the last one padded with 0.
std::vector<float> pack_panels(int k, int n, StridedMatrix b);

}  // namespace polar
