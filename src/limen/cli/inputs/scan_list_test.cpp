// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/cli/inputs/scan_options.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

std::string list_problem(const std::filesystem::path& path) {
  try {
    return std::to_string(names_in_list(path.string()).size()) + " names";
  } catch (const Error& error) {
    return error.problem();
  }
}

TEST(ScanList, NamesAreTakenWithoutWhatStandsAround) {
  const TemporaryFolder folder;
  const auto list =
      folder.write("list.txt", "\xEF\xBB\xBF one.ply \r\n\t# a remark\n\n\t/two three.ply\t\r\nfour.ply");
  EXPECT_EQ(names_in_list(list.string()),
            (std::vector<std::string>{(folder / "one.ply").string(), "/two three.ply",
                                      (folder / "four.ply").string()}));
}

TEST(ScanList, WhatIsNoListIsStated) {
  const TemporaryFolder folder;
  EXPECT_EQ(list_problem(folder / "."), "is a folder, not a list");
  EXPECT_EQ(list_problem(folder / "missing.txt"), "there is no such file");
  EXPECT_NE(list_problem(folder.write("a.ply", "ply\n\x01\x02\n")).find("not a list of names"),
            std::string::npos);
  EXPECT_NE(list_problem(folder.write("latin.txt", "caf\xe9.ply\tb\n")).find("not a list of names"),
            std::string::npos)
      << "JSON cannot tell of it";
}

}  // namespace
}  // namespace limen
