// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>

#include "support/test_support.h"
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/mapped_file.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

TEST(Readable, TheReasonIsStatedOrTheSystemsOwnWords) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.txt", "1");
  const auto beside = [&](const char* name) { return file.parent_path() / name; };
  EXPECT_EQ(why_unreadable(file), "");
  EXPECT_EQ(why_unreadable(beside("b.txt")), "there is no such file");
  EXPECT_EQ(why_unreadable(file / "b.txt"), "there is no such file");
  EXPECT_EQ(why_unreadable(file.parent_path(), "list"), "is a folder, not a list");
  EXPECT_EQ(why_unreadable(""), "the name of a file is empty");
  std::filesystem::create_symlink("loop", beside("loop"));
  EXPECT_EQ(why_unreadable(beside("loop")), reason_of(ELOOP));
  try {
    require_readable(beside("b.txt"), "look");
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), beside("b.txt").string());
    EXPECT_EQ(error.problem(), "there is no such file");
  }
}

TEST(Readable, APipeOrADeviceIsNoFile) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(why_unreadable(folder / "pipe"), "is a pipe or a device, not a file");
  EXPECT_EQ(why_unreadable("/dev/zero", "list"), "is a pipe or a device, not a list");
}

}  // namespace
}  // namespace limen
