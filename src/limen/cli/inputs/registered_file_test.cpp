// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/registered_file.h"

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/files/file_hash.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

std::string file_problem(const ProjectEntry& entry, bool force) {
  try {
    require_registered_file(entry, "project.json", force);
    return {};
  } catch (const Error& error) {
    return error.problem();
  }
}

TEST(RegisteredFile, OtherBytesAndNoFileAreRefused) {
  const TemporaryFolder folder;
  ProjectEntry entry;
  entry.file = folder.write("a.ply", "one").string();
  entry.sha256 = sha256_of("one");
  EXPECT_EQ(file_problem(entry, false), "");
  static_cast<void>(folder.write("a.ply", "two"));
  EXPECT_NE(file_problem(entry, false).find("is not the file registered in project.json"), std::string::npos);
  EXPECT_EQ(file_problem(entry, true), "");
  entry.file = (folder / "b.ply").string();
  EXPECT_EQ(file_problem(entry, false), "there is no such file");
  EXPECT_EQ(file_problem(entry, true), "there is no such file");
}

}  // namespace
}  // namespace limen
