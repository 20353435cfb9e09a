// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/parallel.h"

#include <atomic>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace limen
