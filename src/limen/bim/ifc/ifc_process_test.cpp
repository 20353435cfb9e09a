// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/ifc_process.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "support/test_support.h"
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace limen {
namespace {

using testing_io::TemporaryFolder;

/// A shell script in place of limen_ifc.
class IfcProcess : public testing::Test {
 protected:
  void TearDown() override { unsetenv("LIMEN_IFC_HELPER"); }

  void helper_is(const std::string& script) {
    const auto path = folder_.write("fake", "#!/bin/sh\n" + script);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("LIMEN_IFC_HELPER", path.c_str(), 1);
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(IfcProcess, BoundsHoldBeforeTheFirstInstruction) {
  helper_is("ulimit -v; ulimit -t; ulimit -c\n");
  IfcProcessOptions options;
  options.memory_mb = 1024.0;
  options.memory_mb_per_mb = 0.0;
  options.cpu_s = 77.0;
  const IfcRun run = run_ifc_helper("", {}, options);
  EXPECT_TRUE(run.finished) << run.ended_how;
  EXPECT_EQ(run.output, "1000000\n77\n0\n");
}

TEST_F(IfcProcess, WhatComputesWithoutEndIsStopped) {
  helper_is("while :; do echo x; done\n");
  IfcProcessOptions options;
  options.cpu_s = 1.0;
  options.cpu_s_per_mb = 0.0;
  options.output_mb = 1000.0;
  const IfcRun run = run_ifc_helper("", {}, options);
  EXPECT_FALSE(run.finished);
  EXPECT_NE(run.ended_how.find("signal"), std::string::npos) << run.ended_how;
}

TEST_F(IfcProcess, WhatWritesWithoutEndIsStopped) {
  helper_is("exec cat /dev/zero\n");
  IfcProcessOptions options;
  options.output_mb = 1.0;
  options.output_mb_per_mb = 1.0;
  const IfcRun run = run_ifc_helper(std::string(1000000, 'x'), {}, options);
  EXPECT_FALSE(run.finished);
  EXPECT_NE(run.ended_how.find("more than 2 MB"), std::string::npos) << run.ended_how;
  EXPECT_LT(run.output.size(), 3000000U);
}

/// The number that a process wrote into a file; 0 while there is none.
pid_t number_in(const std::string& path) {
  pid_t number = 0;
  std::ifstream(path) >> number;
  return number;
}

/// Whether it becomes true within some seconds.
template <typename Condition>
bool becomes(const Condition& condition) {
  for (int tick = 0; tick < 1000; ++tick) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// A process that is gone, or only waits for somebody to hear of its end.
bool is_gone(pid_t id) {
  std::string word;
  std::ifstream status("/proc/" + std::to_string(id) + "/stat");
  for (int k = 0; k < 3; ++k) {
    if (!(status >> word)) return true;
  }
  return word == "Z" || word == "X";
}

TEST_F(IfcProcess, DiesWithAProcessThatIsKilled) {
  const std::string stated = in_folder("number");
  helper_is("echo $$ > " + stated + "\nexec sleep 600\n");
  const pid_t caller = fork();
  ASSERT_GE(caller, 0);
  if (caller == 0) {
    run_ifc_helper("", {});
    _exit(0);
  }
  ASSERT_TRUE(becomes([&] { return number_in(stated) > 0; }));
  const pid_t helper = number_in(stated);
  EXPECT_FALSE(is_gone(helper));
  kill(caller, SIGKILL);
  waitpid(caller, nullptr, 0);
  EXPECT_TRUE(becomes([&] { return is_gone(helper); }));
}

}  // namespace
}  // namespace limen
