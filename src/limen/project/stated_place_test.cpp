// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/stated_place.h"

#include <cmath>

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

Matrix3d turned(double degrees) {
  return Eigen::AngleAxisd(radians(degrees), Vector3d::UnitZ()).toRotationMatrix();
}

/// A level scan of a room of 6 x 6 m about its scanner, which is said to be at `x`.
ProjectNode node_at(const Vector3d& x, std::optional<double> yaw_deg = std::nullopt) {
  ProjectNode node;
  node.digest.upright = true;
  node.digest.stations = {Vector3d::Zero()};
  for (const Vector3d& side :
       {Vector3d(3, 0, 0), Vector3d(-3, 0, 0), Vector3d(0, 3, 0), Vector3d(0, -3, 0)}) {
    PlaneDigest plane;
    plane.plane = {side.normalized(), -3.0};
    plane.centroid = side;
    node.digest.planes.push_back(plane);
  }
  node.stated = StatedPlace{};
  node.stated->x = x;
  node.stated->covariance *= 0.25;
  if (yaw_deg) node.stated->frame_from_scan = turned(*yaw_deg);
  node.stated->sigma_rad = radians(5.0);
  return node;
}

TEST(StatedPlace, APoseAsStatedGainsAndOneElsewhereLoses) {
  const ProjectNode target = node_at({652000, 6862000, 35}, 30.0);
  const ProjectNode source = node_at({652004, 6862000, 35}, 120.0);
  const Rigid3 stated{turned(90.0), turned(-30.0) * Vector3d(4, 0, 0)};
  EXPECT_GT(log_prior_of_places(source, target, stated), 4.0);
  EXPECT_NEAR(log_prior_of_places(source, target, {turned(90.0), Vector3d(-4, 0, 0)}), std::log(0.05), 0.1);
  EXPECT_NEAR(log_prior_of_places(source, target, {turned(-90.0), stated.translation}), std::log(0.05), 0.1);
}

TEST(StatedPlace, WithoutHeadingsDistanceAndHeightCount) {
  const ProjectNode target = node_at({0, 0, 0});
  const ProjectNode source = node_at({4, 0, 3});
  for (const double yaw : {0.0, 70.0, 200.0})
    EXPECT_GT(log_prior_of_places(source, target, {turned(yaw), turned(yaw) * Vector3d(4, 0, 3)}), 1.0)
        << yaw;
  EXPECT_LT(log_prior_of_places(source, target, {turned(10.0), Vector3d(4, 0, 0)}), 0.0);
  EXPECT_LT(log_prior_of_places(source, target, {turned(10.0), Vector3d(9, 0, 3)}), 0.0);
}

TEST(StatedPlace, TheOtherWayRoundIsTheSame) {
  const ProjectNode target = node_at({0, 0, 0}, 10.0);
  const ProjectNode source = node_at({2, 1, 0}, 50.0);
  const Rigid3 pose{turned(38.0), Vector3d(2.2, 0.8, 0.1)};
  EXPECT_NEAR(log_prior_of_places(source, target, pose), log_prior_of_places(target, source, inverse(pose)),
              0.2);
}

TEST(StatedPlace, WhatIsNotStatedSaysNothing) {
  ProjectNode unknown = node_at({0, 0, 0});
  unknown.stated.reset();
  EXPECT_EQ(log_prior_of_places(unknown, node_at({0, 0, 0}), {}), 0.0);
  EXPECT_TRUE(can_meet(unknown, node_at({500, 0, 0})));
  EXPECT_FALSE(can_meet(node_at({0, 0, 0}), node_at({40, 0, 0})));
  EXPECT_TRUE(can_meet(node_at({0, 0, 0}), node_at({7, 0, 0})));
}

TEST(StatedPlace, AWrongStatedPositionIsFoundOut) {
  std::vector<ProjectNode> nodes;
  ProjectResult result;
  const Rigid3 grid{turned(20.0), Vector3d(652000, 6862000, 35)};
  for (int k = 0; k < 6; ++k) {
    const Vector3d found(5.0 * k, k % 2 == 0 ? 0.0 : 4.0, k % 3);
    nodes.push_back(node_at(grid * found + (k == 2 ? Vector3d(0, 9, 0) : Vector3d(0.1 * k, 0, 0))));
    nodes.back().scan = static_cast<std::size_t>(k);
    ProjectScan scan;
    scan.file = "scan" + std::to_string(k);
    scan.state = NodeState::registered;
    scan.component = 0;
    scan.frame_from_scan = Rigid3{Matrix3d::Identity(), found};
    result.scans.push_back(scan);
  }
  compare_with_stated(nodes, result);
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_TRUE(result.scans[k].stated && result.scans[k].stated->missed_m) << k;
    EXPECT_EQ(result.scans[k].stated->contradicted, k == 2) << *result.scans[k].stated->missed_m;
  }
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("scan2"), std::string::npos);
}

TEST(StatedPoses, AreReadWithHeadingsOrQuaternionsOrNeither) {
  const TemporaryFolder folder;
  const auto poses = read_stated_poses(folder.write(
      "a.csv",
      "file;x;y;z;sigma;heading;sigma_deg\na.ply;652000,5;6862000;35;0,3;90;2\nb.ply;1;2;3;0,5;;2\n"));
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].x, Vector3d(652000.5, 6862000, 35));
  EXPECT_NEAR(poses[0].covariance(1, 1), 0.09, 1e-12);
  ASSERT_TRUE(poses[0].frame_from_scan.has_value());
  // The scan's y axis points east.
  EXPECT_LT((*poses[0].frame_from_scan * Vector3d::UnitY() - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_FALSE(poses[1].frame_from_scan.has_value());
  const auto turned_too = read_stated_poses(
      folder.write("q.csv", "file,x,y,z,qw,qx,qy,qz\na.ply,1,2,3,0.7071068,0,0,0.7071068\n"));
  EXPECT_TRUE(turned_too[0].of_origin);
  EXPECT_LT((*turned_too[0].frame_from_scan * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-6);
}

TEST(StatedPoses, SayWhatIsWrongWithThem) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> faults[] = {
      {"name,x,y,z\na,1,2,3\n", "no column is called file"},
      {"file,x,y,z\na,1,2,3\na,1,2,3\n", "is given twice"},
      {"file,x,y,z,qw,qx,qy,qz\na,1,2,3,0,0,0,9\n", "the quaternion has the length 9"},
      {"file,x,y,z,sigma\na,1,2,3,0\n", "is not above 0"},
      {"file,x,y\na,1,2\n", "there is no column z"}};
  for (const auto& [text, words] : faults) {
    try {
      static_cast<void>(read_stated_poses(folder.write("a.csv", text)));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find(words), std::string::npos) << error.problem();
      EXPECT_EQ(error.fault(), Fault::input);
    }
  }
}

}  // namespace
}  // namespace limen
