// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/scan_in_file.h"

#include "support/test_support.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(ScanInFile, ANameHasAFileAndANumber) {
  EXPECT_EQ(split_scan_name("all.e57 #12").file, "all.e57");
  EXPECT_EQ(split_scan_name("all.e57 #12").index, 12U);
  EXPECT_EQ(split_scan_name("all.e57#0").index, 0U);
  EXPECT_EQ(split_scan_name("flat #3b.ply").file, "flat #3b.ply");
  EXPECT_FALSE(split_scan_name("flat #3b.ply").index);
}

TEST(ScanInFile, AFileThatIsThereUnderTheWholeNameCountsFirst) {
  const testing_io::TemporaryFolder folder;
  const std::string plain = folder.write("all.e57", "x").string();
  EXPECT_EQ(scan_in_file(plain + " #1").file, plain);
  EXPECT_EQ(scan_in_file(plain + " #1").index, 1U);
  const std::string odd = folder.write("all.e57 #1", "x").string();
  EXPECT_EQ(scan_in_file(odd).file, odd);
  EXPECT_FALSE(scan_in_file(odd).index);
  EXPECT_EQ(file_of_scan(plain + "x #1"), plain + "x #1") << "no such file: the name stays as it was given";
}

}  // namespace
}  // namespace limen
