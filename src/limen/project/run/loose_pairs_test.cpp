// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/run/loose_pairs.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

/// A scan in the middle of a floor of 36 m^2, 1.5 m above it.
ProjectNode over_the_floor() {
  ProjectNode node;
  node.digest.upright = true;
  node.digest.stations = {Vector3d::Zero()};
  PlaneDigest plane;
  plane.plane = {Vector3d::UnitZ(), -1.5};
  plane.centroid = {0.0, 0.0, -1.5};
  plane.area_m2 = 36.0;
  plane.oriented = true;
  for (double x = -2.5; x < 3.0; x += 1.0) {
    for (double y = -2.5; y < 3.0; y += 1.0) plane.moments.add(Vector3d(x, y, 0.0));
  }
  node.digest.planes.push_back(plane);
  return node;
}

/// Three scans over one floor: the second is joined to the first, the third to the second, by links that
/// leave so much open along x.
struct LooselyJoined {
  std::vector<ProjectNode> nodes = {over_the_floor(), over_the_floor(), over_the_floor()};
  ProjectGraph made;

  explicit LooselyJoined(double sigma_m) {
    made.graph.nodes = 3;
    for (int source = 1; source < 3; ++source) {
      GraphLink link;
      link.source = source;
      link.target = source - 1;
      link.chance = 1e-6;
      LinkPose pose;
      pose.target_from_source.translation = {1.0, 0.0, 0.0};
      pose.centre = pose.target_from_source.translation;
      pose.covariance = 1e-6 * Matrix6d::Identity();
      pose.covariance(3, 3) = sigma_m * sigma_m;
      link.poses.push_back(pose);
      made.graph.links.push_back(link);
    }
  }

  [[nodiscard]] std::vector<LoosePair> loose(const UserWords& words = {}) const {
    return loose_pairs(nodes, made, words, solve_graph(made.graph));
  }
};

TEST(LoosePairs, AreScansThatNoLinkJoinsAndTheirLinksHoldLoosely) {
  const std::vector<LoosePair> pairs = LooselyJoined(0.1).loose();
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs.front().source, 2U);
  EXPECT_EQ(pairs.front().target, 0U);
  const LinkPose& placed = pairs.front().placed;
  EXPECT_NEAR(placed.target_from_source.translation.x(), 2.0, 1e-9);
  EXPECT_NEAR(placed.covariance(3, 3), 2.0 * 0.1 * 0.1, 1e-4) << "what the two links leave open";
  EXPECT_LT(placed.covariance(4, 4), 1e-4);
}

TEST(LoosePairs, AreNoneWhereTheLinksHold) {
  EXPECT_TRUE(LooselyJoined(0.005).loose().empty());
}

TEST(LoosePairs, SeeSomethingOfOneAnother) {
  LooselyJoined row(0.1);
  row.nodes[2].digest.planes.front().plane.offset = -3.0;
  row.nodes[2].digest.planes.front().centroid.z() = -3.0;
  EXPECT_TRUE(row.loose().empty());
}

TEST(LoosePairs, AreNoneThatAUserRejected) {
  UserWords words;
  words.pairs[{2, 0}] = {DecisionKind::reject, 0};
  EXPECT_TRUE(LooselyJoined(0.1).loose(words).empty());
}

TEST(LoosePairs, AreOfStaticScans) {
  LooselyJoined row(0.1);
  row.nodes[2].digest.mobile = true;
  EXPECT_TRUE(row.loose().empty());
}

}  // namespace
}  // namespace limen
