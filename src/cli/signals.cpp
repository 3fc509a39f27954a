#include "signals.hpp"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <initializer_list>

namespace polar::cli {

namespace {
constexpr std::int64_t kSameSignal_ns = 1'000'000'000;  // within it, another one is an echo of the first
std::atomic<int> first{0};
std::atomic<std::int64_t> first_at_ns{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "a handler may only touch lock-free atomics");

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

extern "C" void on_signal(int number) {
  int none = 0;
  if (first.compare_exchange_strong(none, number))
    first_at_ns = now_ns();
  else if (first_at_ns != 0 && now_ns() - first_at_ns > kSameSignal_ns)
    ::_exit(128 + number);
}
}  // namespace

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGUSR1}) ::sigaction(number, &action, nullptr);
}

int received_signal() { return first; }

}  // namespace polar::cli
