// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_model_poses.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "limen/match/planes/enumerate_poses.h"

namespace limen {
namespace {

/// A rectangle about `middle` with sides `u` and `v`, facing along u x v.
PlanarPolygon rectangle(const Vector3d& middle, const Vector3d& u, const Vector3d& v) {
  PlanarPolygon polygon;
  polygon.plane.normal = u.cross(v).normalized();
  polygon.plane.offset = polygon.plane.normal.dot(middle);
  polygon.frame = make_frame(polygon.plane, middle);
  Ring ring;
  for (const Vector2d& way :
       {Vector2d(-0.5, -0.5), Vector2d(0.5, -0.5), Vector2d(0.5, 0.5), Vector2d(-0.5, 0.5)})
    ring.push_back(polygon.frame.to_plane(middle + way.x() * u + way.y() * v));
  polygon.area_m2 = u.norm() * v.norm();
  polygon.parts = {{ring, {}}};
  polygon.centroid = middle;
  polygon.oriented = true;
  return polygon;
}

/// The six inner faces of a room, moved.
void add_room(const Vector3d& low, const Vector3d& size, const Rigid3& pose, Features& features) {
  const Vector3d middle = low + 0.5 * size;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = size[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
    const Vector3d v = size[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
    const Vector3d half = 0.5 * size[axis] * Vector3d::Unit(axis);
    features.planes.push_back(
        rectangle(pose * (middle - half), pose.rotation * u, pose.rotation * v));  // faces up the axis
    features.planes.push_back(rectangle(pose * (middle + half), pose.rotation * v, pose.rotation * u));
  }
}

/// The width of the k-th room of a row: no two neighbours alike.
double width_of(int k) {
  return 3.0 + 0.37 * ((7 * k) % 5);
}

/// Rooms beside, behind and above one another.
Features building(int wide, int deep, int high) {
  Features model;
  double x = 0.0;
  for (int i = 0; i < wide; ++i) {
    double y = 0.0;
    for (int j = 0; j < deep; ++j) {
      for (int k = 0; k < high; ++k)
        add_room({x, y, 3.1 * k}, {width_of(i), width_of(i + 2 * j + 1), 2.8}, {}, model);
      y += width_of(i + 2 * j + 1) + 0.2;
    }
    x += width_of(i) + 0.2;
  }
  return model;
}

Rigid3 tilted_pose() {
  return {Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix(), {2.0, -7.0, 1.5}};
}

/// One room of the building as a scan with another frame sees it.
Features scan_of_room(const Rigid3& scan_from_model) {
  Features scan;
  double x = 0.0;
  for (int i = 0; i < 2; ++i) x += width_of(i) + 0.2;
  add_room({x, 0.0, 3.1}, {width_of(2), width_of(3), 2.8}, scan_from_model, scan);
  return scan;
}

bool holds(const std::vector<PoseCandidate>& poses, const Rigid3& truth) {
  return std::any_of(poses.begin(), poses.end(), [&](const PoseCandidate& pose) {
    return (pose.target_from_source.translation - truth.translation).norm() < 0.1 &&
           (pose.target_from_source.rotation - truth.rotation).cwiseAbs().maxCoeff() < 0.01;
  });
}

TEST(EnumerateModelPoses, TheRoomIsAmongThem) {
  const Features model = building(4, 3, 2);
  const Rigid3 truth = inverse(tilted_pose());
  ModelPoseOptions options;
  options.gravity_known = false;
  const std::vector<PoseCandidate> poses = enumerate_model_poses(scan_of_room(tilted_pose()), model, options);
  EXPECT_TRUE(holds(poses, truth));
  EXPECT_TRUE(std::is_sorted(poses.begin(), poses.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
    return a.precedence > b.precedence;
  }));
}

TEST(EnumerateModelPoses, TheMostAreKept) {
  const Features model = building(3, 2, 2);
  const Features scan = scan_of_room({});
  const std::vector<PoseCandidate> all = enumerate_model_poses(scan, model);
  ModelPoseOptions few;
  few.max_poses = 20;
  const std::vector<PoseCandidate> best = enumerate_model_poses(scan, model, few);
  ASSERT_GT(all.size(), 20U);
  ASSERT_EQ(best.size(), 20U);
  for (std::size_t i = 0; i < best.size(); ++i) {
    EXPECT_EQ(best[i].precedence, all[i].precedence);
    EXPECT_EQ(best[i].target_from_source.translation, all[i].target_from_source.translation);
  }
}

/// A room sought in a house of four hundred, in any attitude: boundedly many poses.
TEST(EnumerateModelPoses, OfALargeBuildingThereAreBoundedlyManyPoses) {
  const Features model = building(14, 7, 4);
  ModelPoseOptions options;
  options.gravity_known = false;
  const std::vector<PoseCandidate> poses = enumerate_model_poses(scan_of_room(tilted_pose()), model, options);
  EXPECT_FALSE(poses.empty());
  EXPECT_LE(poses.size(), 60000U);
}

TEST(EnumerateSlidingPoses, ReturnsThoseWhosePlanesHaveMostInCommon) {
  const Features room = scan_of_room({});
  const Features rooms = building(3, 2, 2);
  PoseEnumerationOptions options;
  options.gravity_known = true;
  options.max_poses = 1000000;
  std::vector<PoseCandidate> all = enumerate_sliding_poses(room, rooms, 0.4, options);
  options.max_poses = 200;
  const std::vector<PoseCandidate> best = enumerate_sliding_poses(room, rooms, 0.4, options);
  ASSERT_GT(all.size(), 1000U);
  ASSERT_EQ(best.size(), 200U);
  std::sort(all.begin(), all.end(),
            [](const PoseCandidate& a, const PoseCandidate& b) { return a.precedence > b.precedence; });
  EXPECT_LT(all.back().precedence, all[199].precedence);
  for (const PoseCandidate& pose : best) EXPECT_GE(pose.precedence, all[199].precedence);
}

}  // namespace
}  // namespace limen
