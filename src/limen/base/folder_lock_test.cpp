// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/folder_lock.h"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/error.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

class FolderLockTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] bool is_taken() const {
    try {
      const FolderLock lock(folder_, "is taken", "wait");
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), (folder_.string() + ": is taken (wait)").c_str());
      return true;
    }
    return false;
  }
  fs::path folder_ = fs::temp_directory_path() / ("limen-lock-" + std::to_string(getpid()));
};

TEST_F(FolderLockTest, OneAtATimeAndNothingStays) {
  {
    const FolderLock lock(folder_, "is taken", "wait");
    EXPECT_TRUE(is_taken());
  }
  EXPECT_FALSE(is_taken());
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(FolderLockTest, AKilledProcessHoldsNothing) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t other = fork();
  if (other == 0) {
    const FolderLock lock(folder_, "is taken", "wait");
    if (write(ready[1], "x", 1) == 1) pause();
    _exit(1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_TRUE(is_taken());
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_FALSE(is_taken());
  close(ready[0]);
  close(ready[1]);
}

TEST_F(FolderLockTest, ALinkIsNotFollowed) {
  fs::create_symlink(folder_ / "elsewhere", folder_ / ".limen-lock");
  EXPECT_THROW(FolderLock(folder_, "is taken", "wait"), Error);
  EXPECT_FALSE(fs::exists(folder_ / "elsewhere"));
}

}  // namespace
}  // namespace limen
