#include "smlm/isolation.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <vector>

#include "fixture.hpp"

#if defined(__has_feature)
#define SMLM_HAS_FEATURE(x) __has_feature(x)
#else
#define SMLM_HAS_FEATURE(x) 0
#endif

namespace smlm {
namespace {

using ::testing::HasSubstr;

const ReadingLimits generous{60, std::uint64_t{1} << 30};

TEST(Isolation, WhatSurvivesChangesNothingHere) {
  int touched = 0;
  EXPECT_NO_THROW(require_survival(
      "a", [&] { touched = 1; }, generous));
  EXPECT_NO_THROW(require_survival(
      "a", [] { throw std::runtime_error("an exception is no crash"); }, generous));
  EXPECT_EQ(touched, 0);
}

TEST(Isolation, AnErrorArrivesAsItWasThrown) {
  const Error error = test::error_of([] {
    require_survival(
        "a", [] { throw Error(Fault::numerical, "x.h5:/locs", "is odd", "mend it"); }, generous);
  });
  EXPECT_EQ(error.fault(), Fault::numerical);
  EXPECT_STREQ(error.what(), "x.h5:/locs: is odd: mend it");
}

TEST(Isolation, ACrashIsAnInputErrorThatNamesTheFile) {
  for (const int deadly : {SIGSEGV, SIGABRT, SIGBUS}) {
    const Error error = test::error_of([&] {
      require_survival(
          "some.h5", [&] { std::raise(deadly); }, generous);
    });
    EXPECT_EQ(error.fault(), Fault::input);
    EXPECT_THAT(error.what(), HasSubstr("some.h5: is damaged: it crashes"));
  }
}

TEST(Isolation, AHangEndsAtTheLimit) {
  const auto hang = [] {
    while (true) ::pause();
  };
  const Error error = test::error_of([&] { require_survival("some.h5", hang, {1, std::uint64_t{1} << 30}); });
  EXPECT_EQ(error.fault(), Fault::input);
  EXPECT_THAT(error.what(), HasSubstr("does not end"));
}

TEST(Isolation, MemoryIsLimitedWhetherOrNotItsFailureIsThrown) {
#if defined(__SANITIZE_ADDRESS__) || SMLM_HAS_FEATURE(address_sanitizer) || defined(__SANITIZE_THREAD__) || \
    SMLM_HAS_FEATURE(thread_sanitizer)
  GTEST_SKIP() << "the sanitizer ends the process where an allocation fails";
#endif
  const auto throws = [] { const std::vector<char> much(std::size_t{8} << 30, 'x'); };
  const auto hides = [] {
    for (int i = 0; i < 1 << 20; ++i) {
      void* volatile piece = std::malloc(1 << 20);  // volatile: else it is optimised away
      if (piece == nullptr) return;                 // the child ends: nothing leaks here
    }
  };
  for (const std::function<void()>& greedy : {std::function<void()>(throws), std::function<void()>(hides)}) {
    EXPECT_EQ(test::error_of([&] { require_survival("a", greedy, generous); }).fault(), Fault::resource);
  }
}

TEST(Isolation, AKillIsAResource) {
  EXPECT_EQ(test::error_of([] {
              require_survival(
                  "a", [] { std::raise(SIGKILL); }, generous);
            }).fault(),
            Fault::resource);
}

}  // namespace
}  // namespace smlm
