// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/state/scan_names.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

TEST(ScanNames, ScansOfOneFileAreCalledByTheirNumbersFromZero) {
  const std::vector<NumberedScan> scans = {
      {"in/all.e57", 0, true}, {"in/all.e57", 1, true}, {"in/hall.ply", 0, false}};
  const auto called = [&](const std::string& name) {
    return scans_called(name, scans.size(), [&](std::size_t k) { return scans[k]; });
  };
  using Places = std::vector<std::size_t>;
  for (std::size_t k = 0; k < scans.size(); ++k) EXPECT_EQ(called(scan_name(scans[k])), Places{k});
  EXPECT_EQ(scan_name(scans[0]), "in/all.e57 #0");
  EXPECT_EQ(scan_name(scans[2]), "in/hall.ply");
  EXPECT_EQ(called("all.e57 #0"), Places{0});
  EXPECT_EQ(called("all.e57 #1"), Places{1});
  EXPECT_EQ(called("hall.ply #0"), Places{2});
  EXPECT_EQ(called("all.e57"), (Places{0, 1}));
  EXPECT_EQ(called("all.e57 #2"), Places{});
}

TEST(ScanNames, ANodeIsFoundWhereOneAloneIsCalledSo) {
  std::vector<ProjectScan> scans(2);
  scans[0].file = scans[1].file = "all.e57";
  scans[0].several = scans[1].several = true;
  scans[1].index = 1;
  std::vector<ProjectNode> nodes(2);
  nodes[1].scan = 1;
  EXPECT_EQ(node_called("all.e57 #0", nodes, scans), 0);
  EXPECT_EQ(node_called("all.e57", nodes, scans), -1);
}

}  // namespace
}  // namespace limen
