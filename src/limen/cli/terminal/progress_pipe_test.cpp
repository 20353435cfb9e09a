// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/progress_pipe.h"

#include <array>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace limen {
namespace {

TEST(PipeMonitor, TellsStagesAndSharesAndWaitsForNobody) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_NONBLOCK), 0);
  setenv(kProgressVariable, std::to_string(ends[1]).c_str(), 1);
  const std::unique_ptr<Monitor> monitor = pipe_monitor();
  unsetenv(kProgressVariable);
  ASSERT_NE(monitor, nullptr);
  monitor->begin_stage("reading\na file");
  monitor->advance(1.0, 4.0);
  monitor->advance(2.0, 4.0);  // at once: not shown
  monitor->begin_stage("planes");
  std::array<char, 200> text{};
  const ssize_t got = read(ends[0], text.data(), text.size());
  EXPECT_EQ(std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))),
            "reading a file\nreading a file\t0.2500\nplanes\n");
  for (int k = 0; k < 20000; ++k) monitor->begin_stage("the pipe is full long before this ends");
  close(ends[0]);
  close(ends[1]);
}

TEST(PipeMonitor, IsThereOnlyWhereAnOpenDescriptorIsNamed) {
  for (const char* wrong : {"", "x", "-1", "1", "2", "3x", "99999", "99999999999999"}) {
    setenv(kProgressVariable, wrong, 1);
    EXPECT_EQ(pipe_monitor(), nullptr) << wrong;
  }
  unsetenv(kProgressVariable);
  EXPECT_EQ(pipe_monitor(), nullptr);
}

}  // namespace
}  // namespace limen
