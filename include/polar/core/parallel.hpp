// The one parallel seam: nothing else in the project names TBB. Work is split in blocks of a size the
// caller fixes, never by the number of threads, and partial results are combined in block order, so the
// same input gives the same bits on 1 or 64 threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace polar {

/// Number of threads that parallel work may use now (at least 1).
int thread_limit();

/// Holds the number of threads at `threads` (0: all that the machine grants) while it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// body(i) for i in [0, n), in any order and on any thread. Exceptions of a body reach the caller.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body);

/// body(begin, end, block) over blocks of `block_size` items.
void parallel_blocks(std::size_t n, std::size_t block_size,
                     const std::function<void(std::size_t, std::size_t, std::size_t)>& body);

/// Sum of block_sum(begin, end) over fixed blocks, added in block order.
template <typename T, typename BlockSum>
T ordered_sum(std::size_t n, std::size_t block_size, T zero, BlockSum block_sum) {
  std::vector<T> partial((n + block_size - 1) / block_size, zero);
  parallel_blocks(n, block_size, [&](std::size_t begin, std::size_t end, std::size_t block) {
    partial[block] = block_sum(begin, end);
  });
  for (const T& p : partial) zero += p;
  return zero;
}

}  // namespace polar
