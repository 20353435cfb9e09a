// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/waves.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

/// A room of four walls, each of another distance from the scanner.
ProjectNode room(double size_m) {
  ProjectNode node;
  node.digest.upright = true;
  node.digest.stations = {Vector3d::Zero()};
  for (const Vector3d& way : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    const double away_m = size_m + 0.3 * way.x() + 0.7 * way.y();
    PlaneDigest plane;
    plane.plane = {-way, away_m};
    plane.centroid = away_m * way;
    plane.area_m2 = 6.0;
    plane.oriented = true;
    node.digest.planes.push_back(plane);
  }
  return node;
}

/// How many pairs of rooms are tried where no pair has a pose.
std::size_t tried_in_vain(std::size_t rooms, int pairs_per_scan) {
  std::vector<ProjectNode> nodes;
  for (std::size_t k = 0; k < rooms; ++k) nodes.push_back(room(2.0 + 0.37 * static_cast<double>(k)));
  const auto nothing = [](const PairList& pairs) {
    std::vector<TriedPair> tried;
    for (const auto& [source, target] : pairs) {
      tried.push_back({source, target, {}});
      tried.back().result.outcome = Outcome::no_match;
    }
    return tried;
  };
  return try_in_waves(nodes, {}, 0.001, pairs_per_scan, nothing).size();
}

TEST(Waves, AllPairsOfABuildingAreTriedBeforeItsScansStayApart) {
  EXPECT_EQ(tried_in_vain(30, 12), 435U);
}

TEST(Waves, OfManyScansNoMoreThanSoManyEach) {
  EXPECT_EQ(tried_in_vain(40, 12), 500U);
  EXPECT_EQ(tried_in_vain(60, 12), 720U);
  EXPECT_LE(tried_in_vain(100, 12), 1200U);
}

}  // namespace
}  // namespace limen
