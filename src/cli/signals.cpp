#include "signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <initializer_list>

namespace polar::cli {

namespace {
std::atomic<int> first{0};
static_assert(std::atomic<int>::is_always_lock_free, "a handler may only touch lock-free atomics");

extern "C" void on_signal(int number) {
  int none = 0;
  if (!first.compare_exchange_strong(none, number)) ::_exit(128 + number);
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
