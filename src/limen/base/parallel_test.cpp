// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/parallel.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/sanitizers.h"
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"

namespace limen {
namespace {

class Threads : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};
INSTANTIATE_TEST_SUITE_P(Parallel, Threads, testing::Values(1, 4));

TEST_P(Threads, ACancelledScopeStopsTheLoop) {
  Monitor monitor;
  const CancelScope scope(monitor);
  std::atomic<int> done{0};
  EXPECT_THROW(parallel_for(10000, 1,
                            [&](std::size_t, std::size_t) {
                              ++done;
                              monitor.cancel();
                            }),
               Error);
  EXPECT_GE(done, 1);
  EXPECT_LE(done, GetParam());
}

TEST_P(Threads, AfterAFailureNothingNewIsBegun) {
  std::atomic<int> begun{0};
  const auto fail = [&](std::size_t begin, std::size_t) {
    ++begun;
    throw std::runtime_error(std::to_string(begin));
  };
  try {
    parallel_for(10000, 1, fail);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "0");
  }
  EXPECT_GE(begun, 1);
  EXPECT_LE(begun, GetParam());
}

TEST_P(Threads, AScopeHoldsInsideThePieces) {
  Monitor monitor;
  const CancelScope scope(monitor);
  const auto nested = [&](std::size_t, std::size_t) {
    if (CancelScope::current() != &monitor) throw std::logic_error("no scope");
    parallel_for(2, 1, [](std::size_t, std::size_t) { CancelScope::check(); });
  };
  EXPECT_NO_THROW(parallel_for(100, 1, nested));
}

TEST(CancelScope, EndsWithItsBlockAndTheInnermostCounts) {
  Monitor outer;
  Monitor inner;
  {
    const CancelScope scope(outer);
    outer.cancel();
    {
      const CancelScope nested(inner);
      EXPECT_NO_THROW(CancelScope::check());
    }
    EXPECT_THROW(CancelScope::check(), Error);
  }
  EXPECT_EQ(CancelScope::current(), nullptr);
  EXPECT_NO_THROW(CancelScope::check());
}

/// The sum of 0 ... 9999, on all threads.
std::size_t sum_in_parallel() {
  return parallel_reduce(
      std::size_t{10000}, std::size_t{10}, std::size_t{0},
      [](std::size_t begin, std::size_t end) {
        std::size_t sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += i;
        return sum;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
}

/// What a child that does `work` after a fork ends with; -1 where it does not end within 20 s.
template <typename Work>
int status_of_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);  // its default is to end the process
    work();
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_P(Threads, AForkedChildHasThreadsOfItsOwn) {
#if defined(LIMEN_SANITIZES_THREADS)
  GTEST_SKIP() << "the thread sanitizer allows no threads after a fork of a process with threads";
#endif
  constexpr std::size_t kSum = 49995000;
  ASSERT_EQ(sum_in_parallel(), kSum);
  EXPECT_EQ(status_of_child([] {
              // So does a child of the child.
              const int below = status_of_child([] { _exit(sum_in_parallel() == kSum ? 7 : 1); });
              _exit(below == 7 && sum_in_parallel() == kSum ? 8 : 1);
            }),
            8);
  EXPECT_EQ(sum_in_parallel(), kSum);
}

TEST_P(Threads, AChildForkedAmidWorkHasThreadsOfItsOwn) {
#if defined(LIMEN_SANITIZES_THREADS)
  GTEST_SKIP() << "the thread sanitizer allows no threads after a fork of a process with threads";
#endif
#if defined(LIMEN_SANITIZES_ADDRESSES)
  GTEST_SKIP() << "the allocator of the address sanitizer may be locked by another thread at the fork";
#endif
  std::atomic<bool> stop{false};
  std::thread other([&] {
    while (!stop) sum_in_parallel();
  });
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(status_of_child([] { _exit(sum_in_parallel() == 49995000U ? 8 : 1); }), 8);
  }
  stop = true;
  other.join();
}

}  // namespace
}  // namespace limen
