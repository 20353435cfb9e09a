// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/scans_in_feet.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

/// A scanner so high above a floor.
ProjectNode above_a_floor(double height) {
  ProjectNode node;
  node.digest.upright = true;
  node.digest.stations = {Vector3d::Zero()};
  PlaneDigest floor;
  floor.plane = {Vector3d::UnitZ(), -height};
  floor.centroid = {0.0, 0.0, -height};
  floor.area_m2 = 36.0;
  floor.oriented = true;
  for (double x = -3.0; x <= 3.0; x += 0.5) {
    for (double y = -3.0; y <= 3.0; y += 0.5) floor.moments.add(Vector3d(x, y, 0.0));
  }
  node.digest.planes.push_back(floor);
  return node;
}

std::vector<std::size_t> found(double height, NodeState state) {
  std::vector<ProjectNode> nodes;
  SolvedGraph solved;
  for (const double placed : {1.4, 1.5, 1.75}) {
    nodes.push_back(above_a_floor(placed));
    solved.nodes.emplace_back().state = NodeState::registered;
  }
  nodes.push_back(above_a_floor(height));
  solved.nodes.emplace_back().state = state;
  return scans_in_feet(nodes, solved);
}

TEST(ScansInFeet, StandTooHighByThatFactorAndHaveNoPlace) {
  EXPECT_EQ(found(1.5 / 0.3048, NodeState::floating), std::vector<std::size_t>{3});
  EXPECT_EQ(found(1.6 / 0.3048, NodeState::ambiguous), std::vector<std::size_t>{3});
  EXPECT_TRUE(found(1.5 / 0.3048, NodeState::probable).empty());
  EXPECT_TRUE(found(1.5, NodeState::floating).empty());
  EXPECT_TRUE(found(3.0, NodeState::floating).empty());
}

}  // namespace
}  // namespace limen
