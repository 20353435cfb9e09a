// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/terminal.h"

#include <csignal>

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

TEST(InterruptGuard, AnInterruptCancelsTheMonitor) {
  std::signal(SIGINT, SIG_DFL);  // a shell starts work in the background with interrupts ignored
  Monitor monitor;
  const InterruptGuard guard(monitor);
  EXPECT_NO_THROW(monitor.throw_if_cancelled());
  ASSERT_EQ(std::raise(SIGINT), 0);
  EXPECT_TRUE(monitor.cancelled());
  EXPECT_THROW(monitor.throw_if_cancelled(), Error);
}

TEST(InterruptGuardDeathTest, ASecondInterruptEndsTheProcess) {
  EXPECT_EXIT(
      {
        Monitor monitor;
        const InterruptGuard guard(monitor);
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptGuardDeathTest, AfterwardsAnInterruptIsNoLongerHeard) {
  EXPECT_EXIT(
      {
        Monitor monitor;
        { const InterruptGuard guard(monitor); }
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(MakeMonitor, QuietIsSilent) {
  const std::unique_ptr<Monitor> monitor = make_monitor(true);
  testing::internal::CaptureStderr();
  monitor->begin_stage("planes");
  monitor->advance(1.0, 2.0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(TerminalMonitor, WipesItsLine) {
  testing::internal::CaptureStderr();
  {
    TerminalMonitor monitor;
    monitor.begin_stage("planes");
    monitor.advance(1.0, 2.0);
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_NE(shown.find("planes"), std::string::npos);
  EXPECT_EQ(shown.find('\n'), std::string::npos);
  ASSERT_GE(shown.size(), 4U);
  EXPECT_EQ(shown.substr(shown.size() - 4), "\r\x1b[K");
}

}  // namespace
}  // namespace limen
