// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/progress_line.h"

#include <cmath>

#include <gtest/gtest.h>

namespace limen {
namespace {

constexpr LineStyle kAscii{60, false};

TEST(ProgressLine, ShowsStageBarShareRateAndRemainingTime) {
  const ProgressState state{"reading", WorkUnit::points, 3e6, 12e6, 2.0, 6.2};
  EXPECT_EQ(progress_line(state, {100, false}),
            "reading      [#######.......................]  25 %  7 s left  1.5 M points/s");
  EXPECT_EQ(progress_line({"reading", WorkUnit::bytes, 3e8, 6e8, 2.0, {}}, {100, false}),
            "reading      [###############...............]  50 %  150 MB/s");
  EXPECT_EQ(progress_line({"planes", WorkUnit::steps, 1, 2, 2.0, 125.0}, {100, false}),
            "planes       [###############...............]  50 %  2 min 05 s left");
}

TEST(ProgressLine, ABlockHasEightSteps) {
  EXPECT_EQ(progress_line({"planes", WorkUnit::steps, 9, 16, 0.1, {}}, {30, true}),
            "planes       ▕████▌   ▏  56 %");
}

TEST(ProgressLine, NeverFillsTheLastColumn) {
  const ProgressState state{"hypotheses", WorkUnit::points, 3e6, 12e6, 2.0, 4000.0};
  const ProgressState endless{"hypotheses", WorkUnit::steps, 0, 0, 2.0, {}};
  for (int columns = 4; columns < 120; ++columns) {
    EXPECT_LT(progress_line(state, {columns, false}).size(), static_cast<std::size_t>(columns));
    EXPECT_LT(progress_line(endless, {columns, false}).size(), static_cast<std::size_t>(columns));
  }
}

TEST(ProgressLine, WithoutATotalAMarkTurns) {
  const std::string first = progress_line({"scoring", WorkUnit::steps, 0, 0, 3.0, {}}, kAscii);
  const std::string second = progress_line({"scoring", WorkUnit::steps, 0, 0, 3.13, {}}, kAscii);
  EXPECT_EQ(first.substr(1), " scoring      3 s");
  EXPECT_EQ(first.substr(1), second.substr(1));
  EXPECT_NE(first[0], second[0]);
}

TEST(RemainingTime, IsUnknownAtFirstThenRight) {
  RemainingTime remaining;
  EXPECT_FALSE(remaining.update(0.5, 5.0, 100.0));
  EXPECT_FALSE(remaining.update(2.0, 0.0, 100.0));
  EXPECT_FALSE(remaining.update(2.0, 5.0, 0.0));
  double left = 0.0;
  for (int tick = 20; tick <= 50; ++tick) left = remaining.update(0.1 * tick, tick, 100.0).value();
  EXPECT_NEAR(left, 5.0, 1e-9);
}

TEST(RemainingTime, DoesNotJumpWhereTheWorkDoes) {
  RemainingTime remaining;
  double before = remaining.update(2.0, 20.0, 100.0).value();
  for (int tick = 21; tick <= 100; ++tick) {
    // The work pauses for a second and then catches up.
    const double done = tick < 31 ? 20.0 : tick;
    const double now = remaining.update(0.1 * tick, done, 100.0).value();
    EXPECT_LT(std::abs(now - before), 0.5) << tick;
    before = now;
  }
  EXPECT_NEAR(before, 0.0, 0.2);
}

}  // namespace
}  // namespace limen
