// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/survey/stated_place.h"

#include "support/test_support.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

using testing_io::TemporaryFolder;

Matrix3d turned(double degrees) {
  return Eigen::AngleAxisd(radians(degrees), Vector3d::UnitZ()).toRotationMatrix();
}

/// A level scan of a room of 6 x 6 m about its scanner, which is said to be at `x`.
ProjectNode node_at(const Vector3d& x) {
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
  node.stated = SurveyedPoint{"", x, 0.25 * Matrix3d::Identity()};
  std::vector<ProjectNode> nodes = {node};
  std::vector<std::string> notes;
  take_stated_positions({}, {}, {}, nodes, notes);
  return nodes.front();
}

TEST(StatedPlace, WhatIsNotStatedSaysNothing) {
  ProjectNode unknown = node_at({0, 0, 0});
  unknown.stated.reset();
  EXPECT_TRUE(can_meet(unknown, node_at({500, 0, 0})));
  EXPECT_FALSE(can_meet(node_at({0, 0, 0}), node_at({40, 0, 0})));
  EXPECT_TRUE(can_meet(node_at({0, 0, 0}), node_at({7, 0, 0})));
}

TEST(StatedPlace, OneThatIsTooFarFromAllOthersIsNoted) {
  std::vector<ProjectNode> nodes = {node_at({0, 0, 0}), node_at({5, 0, 0}), node_at({270, 0, 0}),
                                    node_at({9, 9, 0})};
  nodes[3].stated.reset();
  ProjectResult result;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    nodes[k].scan = k;
    result.scans.emplace_back();
    result.scans.back().file = std::string(1, static_cast<char>('a' + k));
  }
  compare_with_stated(nodes, result);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_EQ(result.notes[0], "the stated position of c is too far from all others for an overlap: check it");
}

/// Six scans in a frame, on one storey or not, whose stated positions are `stated(k, true one)`.
template <typename Stated>
ProjectResult compared_with(const Stated& stated, bool storey) {
  std::vector<ProjectNode> nodes;
  ProjectResult result;
  const Rigid3 grid{turned(20.0), Vector3d(652000, 6862000, 35)};
  for (int k = 0; k < 6; ++k) {
    const Vector3d found(5.0 * k, k % 2 == 0 ? 0.0 : 4.0, storey ? 0.0 : k % 3);
    nodes.push_back(node_at(stated(k, grid * found)));
    nodes.back().digest.upright = true;
    nodes.back().scan = static_cast<std::size_t>(k);
    ProjectScan scan;
    scan.file = "scan" + std::to_string(k);
    scan.state = NodeState::registered;
    scan.component = 0;
    scan.frame_from_scan = Rigid3{Matrix3d::Identity(), found};
    result.scans.push_back(scan);
  }
  compare_with_stated(nodes, result);
  return result;
}

/// The same, off by `off(k)`.
template <typename Off>
ProjectResult compared_with_stated(const Off& off) {
  return compared_with([&](int k, const Vector3d& x) -> Vector3d { return x + Vector3d(off(k)); }, false);
}

TEST(StatedPlace, ExchangedColumnsAreNotedAndNoScanIsBlamed) {
  const ProjectResult result =
      compared_with([](int, const Vector3d& x) { return Vector3d(x.y(), x.x(), x.z()); }, true);
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("x and y may be exchanged"), std::string::npos) << result.notes[0];
  for (const ProjectScan& scan : result.scans) EXPECT_FALSE(scan.stated->contradicted);
}

TEST(StatedPlace, PositionsThatAreAllWrongAreNoted) {
  RandomStream random(7);
  const ProjectResult result = compared_with_stated(
      [&](int) { return uniform_vector(Vector3d(-30, -30, -3), Vector3d(30, 30, 3), random); });
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("contradict the stated positions"), std::string::npos) << result.notes[0];
}

TEST(StatedPlace, AWrongStatedPositionIsFoundOut) {
  const ProjectResult result =
      compared_with_stated([](int k) { return k == 2 ? Vector3d(0, 9, 0) : Vector3d(0.1 * k, 0, 0); });
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_TRUE(result.scans[k].stated && result.scans[k].stated->missed_m) << k;
    EXPECT_EQ(result.scans[k].stated->contradicted, k == 2) << *result.scans[k].stated->missed_m;
  }
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("scan2"), std::string::npos);
}

TEST(StatedPositions, AreReadWithTheirDeviationsOrOneMetre) {
  const TemporaryFolder folder;
  const auto stated =
      read_stated_positions(folder.write("a.csv", "file;x;y;z;sigma\na.ply;652000,5;6862000;35;0,3\n"));
  ASSERT_EQ(stated.size(), 1U);
  EXPECT_EQ(stated[0].name, "a.ply");
  EXPECT_EQ(stated[0].x, Vector3d(652000.5, 6862000, 35));
  EXPECT_NEAR(stated[0].covariance(1, 1), 0.09, 1e-12);
  const auto bare = read_stated_positions(folder.write("b.csv", "file,x,y,z\nall.e57 #1,1,2,3\n"));
  EXPECT_EQ(bare[0].name, "all.e57 #1");
  EXPECT_EQ(bare[0].covariance, Matrix3d(Matrix3d::Identity()));
}

TEST(StatedPositions, SayWhatIsWrongWithThem) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> faults[] = {
      {"name,x,y,z\na,1,2,3\n", "no column is called file"},
      {"file,x,y,z\na,1,2,3\na,1,2,3\n", "is given twice"},
      {"file,x,y,z,sigma\na,1,2,3,0\n", "is not above 0"},
      {"file,x,y\na,1,2\n", "there is no column z"},
      {"file,x,y,z,x\na,1,2,3,4\n", "two columns are called x"},
      {"file,x,y,z,sigma,sigma_x,sigma_y,sigma_z\na,1,2,3,1,1,1,1\n",
       "columns sigma and sigma_x, which state the same"},
      {"file,x,y,z\n", "no row follows"}};
  for (const auto& [text, words] : faults) {
    try {
      static_cast<void>(read_stated_positions(folder.write("a.csv", text)));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find(words), std::string::npos) << error.problem();
      EXPECT_EQ(error.fault(), Fault::input);
    }
  }
}

/// A file's own poses are given to millimetres; taken as approximate they are positions.
TEST(StatedPositions, OfAFileReplaceItsExactPoses) {
  std::vector<ProjectNode> nodes = {node_at({0, 0, 0}), node_at({0, 0, 0})};
  for (ProjectNode& node : nodes) {
    node.stated.reset();
    node.grouped = true;
    node.digest.local_origin = Vector3d(100, 200, 3);
  }
  std::vector<std::string> notes;
  const std::vector<ProjectScan> scans(2);
  take_stated_positions({}, std::nullopt, scans, nodes, notes);
  EXPECT_TRUE(nodes[0].grouped);
  EXPECT_FALSE(nodes[0].stated.has_value());
  take_stated_positions({}, 0.5, scans, nodes, notes);
  EXPECT_FALSE(nodes[1].grouped);
  ASSERT_TRUE(nodes[1].stated.has_value());
  EXPECT_EQ(nodes[1].stated->x, Vector3d(100, 200, 3));
  EXPECT_NEAR(nodes[1].stated->covariance(0, 0), 0.25, 1e-12);
}

}  // namespace
}  // namespace limen
