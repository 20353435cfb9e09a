// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"

namespace limen {
namespace {

class RunBoth : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};
INSTANTIATE_TEST_SUITE_P(Threads, RunBoth, testing::Values(1, 2, 4));

double sum_in_pieces(std::size_t size) {
  return parallel_reduce(
      size, 7, 0.0,
      [](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += 1.0 / static_cast<double>(i + 1);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

TEST_P(RunBoth, EachDoesItsOwnParallelWorkToTheSameBits) {
  const double alone = sum_in_pieces(100000);
  double first = 0.0;
  double second = 0.0;
  run_both([&] { first = sum_in_pieces(100000); }, [&] { second = sum_in_pieces(100000); });
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

TEST_P(RunBoth, TheFirstFailureIsStated) {
  const auto fail = [](const std::string& what) { return [what] { throw std::runtime_error(what); }; };
  const auto stated = [](const std::function<void()>& first, const std::function<void()>& second) {
    try {
      run_both(first, second);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(stated(fail("first"), fail("second")), "first");
  EXPECT_EQ(stated([] {}, fail("second")), "second");
  EXPECT_EQ(stated([] {}, [] {}), "nothing");
}

TEST_P(RunBoth, BothHeedACancelledScope) {
  Monitor monitor;
  const CancelScope scope(monitor);
  monitor.cancel();
  std::atomic<int> heeded{0};
  const auto work = [&] {
    try {
      CancelScope::check();
    } catch (const Error&) {
      ++heeded;
    }
  };
  run_both(work, work);
  EXPECT_EQ(heeded, 2);
}

}  // namespace
}  // namespace limen
