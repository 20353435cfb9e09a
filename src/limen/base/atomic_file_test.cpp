// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/atomic_file.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
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

}  // namespace
}  // namespace limen
