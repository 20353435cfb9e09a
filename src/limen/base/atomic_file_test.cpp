// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/atomic_file.h"

#include <array>
#include <csignal>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/error.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("limen-" + std::string(info->name()) + "-" + std::to_string(static_cast<long>(getpid())));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  [[nodiscard]] long entries() const {
    return static_cast<long>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, AppearsWholeOnlyAtCommit) {
  AtomicFile file(folder_ / "a.txt");
  file.write("first ");
  file.write("second");
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
  file.commit();
  EXPECT_EQ(text_of("a.txt"), "first second");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStaysAndNothingElse) {
  write_file(folder_ / "a.txt", "old");
  {
    AtomicFile file(folder_ / "a.txt");
    file.write(std::string(3 << 20, 'x'));
  }
  EXPECT_EQ(text_of("a.txt"), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFileTest, TakesTheLongestNamesThatAFileCanHave) {
  const std::string name(255, 'x');
  write_file(folder_ / name, "all");
  EXPECT_EQ(text_of(name), "all");
}

TEST_F(AtomicFileTest, KeepsALinkAndReplacesWhatItPointsTo) {
  write_file(folder_ / "real.txt", "old");
  fs::create_symlink(folder_ / "real.txt", folder_ / "link.txt");
  write_file(folder_ / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(text_of("real.txt"), "new");
}

TEST_F(AtomicFileTest, WritesStraightToADevice) {
  write_file("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, ANamedPipeNeedsItsReader) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(AtomicFile{pipe}, Error);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_file(pipe, "bytes");
  std::array<char, 9> got{};
  EXPECT_EQ(read(reader, got.data(), got.size()), 5);
  EXPECT_STREQ(got.data(), "bytes");
  close(reader);
}

TEST_F(AtomicFileTest, RefusesAFolderAndAMissingPlace) {
  EXPECT_THROW(AtomicFile{folder_}, Error);
  EXPECT_THROW(AtomicFile{folder_ / "missing" / "a.txt"}, Error);
  EXPECT_EQ(entries(), 0);
}

TEST_F(AtomicFileTest, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this machine has no /dev/full";
  EXPECT_THROW(write_file("/dev/full", "some bytes"), Error);
}

TEST_F(AtomicFileTest, OutputFolderLeavesNothingWhereNothingWasWritten) {
  {
    const OutputFolder out(folder_ / "made" / "deep/");
    EXPECT_TRUE(fs::is_directory(folder_ / "made" / "deep"));
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(AtomicFileTest, OutputFolderKeepsResultsAndFoldersThatWereThere) {
  fs::create_directories(folder_ / "there");
  {
    const OutputFolder there(folder_ / "there");
    const OutputFolder filled(folder_ / "made" / "filled");
    write_file(filled.path() / "a.txt", "kept");
  }
  EXPECT_TRUE(fs::is_directory(folder_ / "there"));
  EXPECT_EQ(text_of("made/filled/a.txt"), "kept");
}

TEST_F(AtomicFileTest, OutputFolderBelowAFileIsRefused) {
  write_file(folder_ / "file", "x");
  EXPECT_THROW(OutputFolder{folder_ / "file"}, Error);
  EXPECT_THROW(OutputFolder{folder_ / "file" / "below"}, Error);
}

/// A child that writes to `path` and is killed on its way.
void write_and_be_killed(const fs::path& path) {
  const pid_t child = fork();
  if (child == 0) {
    AtomicFile file(path);
    file.write(std::string(3 << 20, 'x'));
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
}

TEST_F(AtomicFileTest, WhatAKilledProcessLeftIsRemovedByTheNext) {
  write_and_be_killed(folder_ / "a.txt");
  ASSERT_EQ(entries(), 1);  // the hidden file
  write_file(folder_ / "b.txt", "new");
  EXPECT_EQ(entries(), 1);
  EXPECT_EQ(text_of("b.txt"), "new");
}

TEST_F(AtomicFileTest, OutputFolderRemovesWhatAKilledProcessLeft) {
  write_and_be_killed(folder_ / "a.txt");
  const OutputFolder out(folder_);
  EXPECT_EQ(entries(), 0);
}

TEST_F(AtomicFileTest, FilesOfOthersAreLeftAlone) {
  for (const char* name : {".a.part", "a.limen-1-0.part", ".limen-1-0.part", ".a.limen-x-0.part",
                           ".a.limen-1.part", ".a.limen-1-0.party", ".a.txt.12-0.part"})
    std::ofstream(folder_ / name) << "a user's own";
  fs::create_directories(folder_ / ".b.limen-1-0.part");
  fs::create_symlink(folder_ / ".a.part", folder_ / ".c.limen-1-0.part");
  const long before = entries();
  AtomicFile unfinished(folder_ / "d.txt");
  const pid_t child = fork();
  if (child == 0) {
    // Under another name the folder is looked into once more.
    fs::rename(folder_, folder_.string() + "2");
    write_file(folder_.string() + "2/e.txt", "");
    fs::remove(folder_.string() + "2/e.txt");
    fs::rename(folder_.string() + "2", folder_);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  unfinished.write("whole");
  unfinished.commit();
  EXPECT_EQ(text_of("d.txt"), "whole");
  EXPECT_EQ(entries(), before + 1);
}

TEST_F(AtomicFileTest, FilesThatBelongTogetherAppearTogetherOrNotAtAll) {
  write_files({{folder_ / "a.txt", "one"}, {folder_ / "b.txt", "two"}});
  EXPECT_EQ(text_of("a.txt") + text_of("b.txt"), "onetwo");
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &small);
    try {
      write_files({{folder_ / "a.txt", "new"}, {folder_ / "b.txt", std::string(5000, 'x')}});
    } catch (const Error&) {
      _exit(8);
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 8);
  EXPECT_EQ(text_of("a.txt") + text_of("b.txt"), "onetwo");
  EXPECT_EQ(entries(), 2);
}

}  // namespace
}  // namespace limen
