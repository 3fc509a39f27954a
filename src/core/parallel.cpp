#include "polar/core/parallel.hpp"

#include <algorithm>

#ifdef POLAR_SERIAL_TBB
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#else
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace polar {

#ifdef POLAR_SERIAL_TBB
// The same seam on std::thread: the distribution's TBB is not built for ThreadSanitizer, which then
// reports races that are none.
namespace {
std::atomic<int> limit{0};
thread_local bool inside = false;
int hardware() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }
}  // namespace

struct ThreadLimit::Impl {
  int previous = 0;
};
ThreadLimit::ThreadLimit(int threads) : impl_(new Impl{limit.exchange(threads)}) {}
ThreadLimit::~ThreadLimit() { limit = impl_->previous; }
int thread_limit() { return limit > 0 ? std::min(limit.load(), hardware()) : hardware(); }

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body) {
  if (inside || thread_limit() == 1) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex guard;
  std::exception_ptr failure;
  const auto work = [&] {
    inside = true;
    try {
      for (std::size_t i = next++; i < n; i = next++) body(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      failure = std::current_exception();
    }
    inside = false;
  };
  std::vector<std::thread> threads;
  for (int t = 0; t < thread_limit(); ++t) threads.emplace_back(work);
  for (auto& t : threads) t.join();
  if (failure) std::rethrow_exception(failure);
}
#else
struct ThreadLimit::Impl {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : impl_(new Impl{tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          threads > 0 ? static_cast<std::size_t>(threads)
                      : static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()))}) {}
ThreadLimit::~ThreadLimit() = default;

int thread_limit() {
  return std::max(1, std::min(tbb::this_task_arena::max_concurrency(),
                              static_cast<int>(tbb::global_control::active_value(
                                  tbb::global_control::max_allowed_parallelism))));
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) { body(i); });
}
#endif

void parallel_blocks(std::size_t n, std::size_t block_size,
                     const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  const std::size_t blocks = (n + block_size - 1) / block_size;
  parallel_for(blocks, [&](std::size_t b) { body(b * block_size, std::min(n, (b + 1) * block_size), b); });
}

}  // namespace polar
