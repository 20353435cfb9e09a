// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/enumerate_segment_poses.h"

#include "support/synthetic_segments.h"
#include <gtest/gtest.h>

#include "limen/base/parallel.h"
#include "limen/geometry/random_vectors.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/segment_lookup.h"

namespace limen {
namespace {

Vector3d middle_of(const std::vector<Segment>& segments) {
  Vector3d sum = Vector3d::Zero();
  for (const Segment& s : segments) sum += 0.5 * (s.a + s.b);
  return sum / static_cast<double>(segments.size());
}

/// Place of the true pose in the list, or -1.
int place_of(const Rigid3& truth, const std::vector<PoseCandidate>& poses, const Vector3d& middle) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Rigid3& pose = poses[i].target_from_source;
    if ((pose * middle - truth * middle).norm() < 0.05 &&
        rotation_angle(pose.rotation.transpose() * truth.rotation) < radians(1.5))
      return static_cast<int>(i);
  }
  return -1;
}

struct RoomInModel {
  std::vector<Segment> scan;  // in its own frame
  std::vector<Segment> model;
  Rigid3 model_from_scan;
};

RoomInModel room_in_model(std::uint64_t seed, bool level) {
  RandomStream random(41, seed);
  const auto rooms = synthetic::random_building(2, 3, 3, random);
  RoomInModel it;
  it.model = synthetic::joined(rooms);
  const auto& room = rooms[random.below(static_cast<std::uint32_t>(rooms.size()))];
  it.model_from_scan.rotation =
      level ? synthetic::random_heading(random) : synthetic::random_rotation(random);
  it.model_from_scan.translation = {random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-9, 9)};
  it.scan = synthetic::moved(synthetic::detect(room, {}, random), inverse(it.model_from_scan));
  return it;
}

TEST(EnumerateSegmentPoses, ARoomIsFoundInABuildingInAnyRotation) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RoomInModel it = room_in_model(seed, false);
    SegmentPoseOptions options;
    options.gravity_known = false;
    const auto poses = enumerate_segment_poses(it.scan, it.model, options);
    EXPECT_EQ(place_of(it.model_from_scan, poses, middle_of(it.scan)), 0) << "seed " << seed;
    // The larger set may come first too.
    const auto back = enumerate_segment_poses(it.model, it.scan, options);
    EXPECT_EQ(place_of(inverse(it.model_from_scan), back, it.model_from_scan * middle_of(it.scan)), 0);
  }
}

TEST(EnumerateSegmentPoses, KnownGravityKeepsTheVertical) {
  const RoomInModel it = room_in_model(3, true);
  const auto poses = enumerate_segment_poses(it.scan, it.model);
  EXPECT_EQ(place_of(it.model_from_scan, poses, middle_of(it.scan)), 0);
  for (const PoseCandidate& pose : poses)
    EXPECT_GT(pose.target_from_source.rotation(2, 2), std::cos(radians(4.0)));
}

TEST(EnumerateSegmentPoses, EveryCopyOfARoomIsAmongTheBest) {
  RandomStream random(5);
  const auto room = synthetic::random_room({0, 0, 0}, {4.2, 3.1, 2.7}, random);
  std::vector<Segment> model;
  std::vector<Rigid3> truths;
  const Rigid3 scan_from_room{synthetic::random_rotation(random), Vector3d(3, -2, 1)};
  for (int i = 0; i < 24; ++i) {
    const Rigid3 model_from_room{Matrix3d::Identity(), Vector3d(4.4 * (i % 6), 3.4 * (i / 6), 0.0)};
    for (const Segment& edge : synthetic::moved(room, model_from_room)) model.push_back(edge);
    truths.push_back(model_from_room * inverse(scan_from_room));
  }
  const auto scan = synthetic::moved(synthetic::detect(room, {}, random), scan_from_room);
  SegmentPoseOptions options;
  options.gravity_known = false;
  const auto poses = enumerate_segment_poses(scan, model, options);
  for (const Rigid3& truth : truths) {
    const int place = place_of(truth, poses, middle_of(scan));
    EXPECT_GE(place, 0);
    EXPECT_LT(place, 24);
  }
}

TEST(EnumerateSegmentPoses, ThePosesAreDistinctSortedAndTheSameForAnyThreads) {
  const RoomInModel it = room_in_model(1, false);
  SegmentPoseOptions options;
  options.gravity_known = false;
  set_thread_count(1);
  const auto one = enumerate_segment_poses(it.scan, it.model, options);
  set_thread_count(3);
  const auto three = enumerate_segment_poses(it.scan, it.model, options);
  set_thread_count(0);
  ASSERT_EQ(one.size(), three.size());
  const Vector3d middle = middle_of(it.scan);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(to_matrix(one[i].target_from_source), to_matrix(three[i].target_from_source));
    EXPECT_EQ(one[i].precedence, three[i].precedence);
    EXPECT_LE(one[i].precedence, one[i > 0 ? i - 1 : 0].precedence);
    for (std::size_t j = 0; j < std::min<std::size_t>(i, 50); ++j) {
      const double shift = (one[i].target_from_source * middle - one[j].target_from_source * middle).norm();
      const double turn =
          rotation_angle(one[i].target_from_source.rotation.transpose() * one[j].target_from_source.rotation);
      EXPECT_TRUE(shift > 0.1 || turn > radians(1.5));
    }
  }
}

TEST(EnumerateSegmentPoses, ParallelSegmentsLeaveTheirShiftOpen) {
  RandomStream random(8);
  std::vector<Segment> poles;
  for (int i = 0; i < 9; ++i) {
    const Vector3d foot = uniform_vector(Vector3d(0, 0, -1), Vector3d(12, 9, 1), random);
    poles.push_back({foot, foot + Vector3d(0, 0, random.uniform(1, 3))});
  }
  const Rigid3 truth{synthetic::random_rotation(random), Vector3d(7, 8, 9)};
  SegmentPoseOptions options;
  options.gravity_known = false;
  const auto poses = enumerate_segment_poses(poles, synthetic::moved(poles, truth), options);
  ASSERT_FALSE(poses.empty());
  const Vector3d along = truth.rotation * Vector3d::UnitZ();
  const Vector3d off = poses.front().target_from_source * middle_of(poles) - truth * middle_of(poles);
  EXPECT_LT((off - along.dot(off) * along).norm(), 0.05);
}

TEST(EnumerateSegmentPoses, NothingInNothingOut) {
  EXPECT_TRUE(enumerate_segment_poses({}, {{Vector3d::Zero(), Vector3d::UnitX()}}).empty());
  const std::vector<Segment> dots(4);
  EXPECT_TRUE(enumerate_segment_poses(dots, dots).empty());
}

TEST(DirectionClusters, SegmentsClusterByLength) {
  const std::vector<Segment> segments = {
      {{0, 0, 0}, {0, 0, 3}}, {{1, 0, 2}, {1, 0.001, 0}}, {{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}};
  DirectionClusterOptions options;
  options.max_angle_rad = radians(5.0);
  options.max_clusters = 0;
  const DirectionClusters found = cluster_directions(segments, std::nullopt, options);
  ASSERT_EQ(found.clusters.size(), 2U);
  EXPECT_EQ(found.clusters[0].planes, (std::vector<int>{0, 1}));
  EXPECT_NEAR(found.clusters[0].weight, 5.0, 1e-3);
  EXPECT_EQ(found.clusters[1].planes, (std::vector<int>{3}));
}

TEST(SegmentLookup, AgreesWithLookingAtAll) {
  RandomStream random(2);
  std::vector<Segment> segments;
  const auto point = [&] { return uniform_vector(Vector3d(-5, -5, -2), Vector3d(5, 5, 2), random); };
  for (int i = 0; i < 200; ++i) segments.push_back({point(), point()});
  const double reach = 0.3;
  const double angle = radians(30.0);
  const SegmentLookup lookup(segments, reach, angle);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d x = 1.2 * point();
    const Vector3d d = (point() - point()).normalized();
    SegmentHit nearest;
    nearest.distance_m = reach;
    for (std::size_t k = 0; k < segments.size(); ++k) {
      if (std::abs(segments[k].direction().dot(d)) < std::cos(angle)) continue;
      const Vector3d off = x - segments[k].a;
      const double along = std::clamp(segments[k].direction().dot(off), 0.0, segments[k].length());
      const double distance = (off - along * segments[k].direction()).norm();
      if (distance < nearest.distance_m) nearest = {static_cast<int>(k), distance};
    }
    const SegmentHit hit = lookup.nearest(x, d);
    EXPECT_EQ(hit.segment, nearest.segment);
    if (hit.segment < 0) continue;
    EXPECT_NEAR(hit.distance_m, nearest.distance_m, 1e-9);
    ++hits;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace limen
