#include "polar/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace polar {
namespace {

float sum_of_roots(std::size_t n) {
  return ordered_sum(n, 64, 0.0f, [](std::size_t begin, std::size_t end) {
    float s = 0;
    for (std::size_t i = begin; i < end; ++i) s += std::sqrt(static_cast<float>(i));
    return s;
  });
}

TEST(OrderedSum, hasTheSameBitsForAnyNumberOfThreads) {
  float one = 0;
  {
    const ThreadLimit limit(1);
    one = sum_of_roots(100000);
  }
  for (const int threads : {2, 3, 8}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(sum_of_roots(100000), one) << threads;
  }
}

TEST(ParallelFor, visitsEveryIndexOnceAndUsesSeveralThreadsWhereThereAreSome) {
  const ThreadLimit limit(2);
  std::vector<std::atomic<int>> visits(2000);
  std::mutex guard;
  std::set<std::thread::id> threads;
  parallel_for(visits.size(), [&](std::size_t i) {
    ++visits[i];
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    const std::lock_guard<std::mutex> lock(guard);
    threads.insert(std::this_thread::get_id());
  });
  for (const auto& v : visits) EXPECT_EQ(v, 1);
  if (std::thread::hardware_concurrency() > 1) {
    EXPECT_EQ(threads.size(), 2u);
  }
}

TEST(ParallelFor, handsAnExceptionToTheCaller) {
  EXPECT_THROW(parallel_for(100,
                            [](std::size_t i) {
                              if (i == 57) throw std::runtime_error("57");
                            }),
               std::runtime_error);
}

}  // namespace
}  // namespace polar
