// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/cli/inputs/register_inputs.h"

namespace limen {
namespace {

TEST(SamePoints, FilesAreComparedByTheirBytes) {
  const testing_io::TemporaryFolder folder;
  const std::string a = folder.write("a", "one").string();
  const std::string b = folder.write("b", "one").string();
  const std::string c = folder.write("c", "two").string();
  EXPECT_TRUE(same_bytes(a, a));
  EXPECT_TRUE(same_bytes(a, b));
  EXPECT_FALSE(same_bytes(a, c));
  EXPECT_FALSE(same_bytes(a, a + "x"));
  EXPECT_FALSE(same_bytes(a + " #0", a + " #1")) << "two scans of one file";
}

}  // namespace
}  // namespace limen
