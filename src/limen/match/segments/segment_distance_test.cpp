// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/segment_distance.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

Segment along_x(double from, double to, double y = 0.0, double z = 0.0) {
  return {Vector3d(from, y, z), Vector3d(to, y, z)};
}

/// Edges of windows with noise: near parallels at small distances, of different lengths and directions.
std::vector<Segment> messy_set(RandomStream& random, int count) {
  std::vector<Segment> set;
  for (int i = 0; i < count; ++i) {
    const Vector3d start(random.uniform(0.0, 3.0), 0.05 * random.normal(), random.uniform(0.0, 2.0));
    const Vector3d axis = random.below(2) == 0 ? Vector3d::UnitX() : Vector3d::UnitZ();
    const Vector3d tilt = 0.02 * normal_vector(random);
    const Vector3d end = start + random.uniform(0.3, 2.0) * (axis + tilt);
    set.push_back(random.below(2) == 0 ? Segment{start, end} : Segment{end, start});
  }
  return set;
}

Rigid3 some_pose(RandomStream& random) {
  return {rotation_exp(normal_vector(random)), 10.0 * normal_vector(random)};
}

std::vector<Segment> moved(const Rigid3& pose, const std::vector<Segment>& set) {
  std::vector<Segment> result;
  for (const Segment& s : set) result.push_back({pose * s.a, pose * s.b});
  return result;
}

/// (14).
double segment_set_distance(const std::vector<Segment>& a, const std::vector<Segment>& b,
                            const SegmentDistanceOptions& options = {}) {
  return SegmentSetMeasure(b, options).to(a).distance;
}

/// (9) or (7).
double segment_to_set_distance(const Segment& segment, const std::vector<Segment>& set,
                               const SegmentDistanceOptions& options = {}) {
  return SegmentSetMeasure(set, options).to({segment}).source_distance;
}

/// (9) by walking along the segment: at every place the nearest segment that covers it takes off its gain.
double walked_distance(const Segment& segment, const std::vector<Segment>& set,
                       const SegmentDistanceOptions& options) {
  constexpr int kSteps = 20000;
  const double squared = options.max_distance_m * options.max_distance_m;
  std::vector<SegmentOverlap> overlaps;
  for (const Segment& other : set) {
    if (const auto common = overlap_of(segment, other, options)) overlaps.push_back(*common);
  }
  const double step = segment.length() / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) * step;
    double least = squared;
    for (const SegmentOverlap& o : overlaps) {
      if (s > o.first_from_m && s < o.first_to_m) least = std::min(least, o.distance_m * o.distance_m);
    }
    sum += least * step;
  }
  return sum;
}

TEST(SegmentDistance, ParallelSegmentsHaveTheirSpacing) {
  const auto common = overlap_of(along_x(0.0, 2.0), along_x(1.5, 0.5, 0.04));
  ASSERT_TRUE(common);
  EXPECT_NEAR(common->distance_m, 0.04, 1e-12);
  EXPECT_NEAR(common->first_from_m, 0.5, 1e-12);
  EXPECT_NEAR(common->first_to_m, 1.5, 1e-12);
  EXPECT_NEAR(common->second_from_m, 0.0, 1e-12);
  EXPECT_NEAR(common->second_to_m, 1.0, 1e-12);
}

TEST(SegmentDistance, SegmentsApartOrCrossingHaveNothingInCommon) {
  EXPECT_FALSE(overlap_of(along_x(0.0, 1.0), along_x(1.1, 2.0)));
  const Segment upright{Vector3d(0.5, 0.0, -0.5), Vector3d(0.5, 0.0, 0.5)};
  EXPECT_FALSE(overlap_of(along_x(0.0, 1.0), upright));
  const SegmentDistanceOptions options;
  const double d2 = options.max_distance_m * options.max_distance_m;
  EXPECT_DOUBLE_EQ(segment_set_distance({along_x(0.0, 1.0)}, {upright}, options), 2.0 * d2);
  EXPECT_DOUBLE_EQ(segment_to_set_distance(along_x(0.0, 3.0), {along_x(4.0, 5.0)}, options), 3.0 * d2);
}

TEST(SegmentDistance, IsZeroToItselfAndDoesNotAskForSigns) {
  RandomStream random(1);
  std::vector<Segment> set = messy_set(random, 20);
  EXPECT_NEAR(segment_set_distance(set, set), 0.0, 1e-12);
  std::vector<Segment> turned_round;
  for (const Segment& s : set) turned_round.push_back({s.b, s.a});
  EXPECT_NEAR(segment_set_distance(set, turned_round), 0.0, 1e-12);
}

TEST(SegmentDistance, IsSymmetricAndMovesWithTheScene) {
  RandomStream random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const auto a = messy_set(random, 15);
    const auto b = messy_set(random, 12);
    for (const SegmentWeight weight : {SegmentWeight::length, SegmentWeight::relative}) {
      SegmentDistanceOptions options;
      options.weight = weight;
      const double distance = segment_set_distance(a, b, options);
      EXPECT_NEAR(segment_set_distance(b, a, options), distance, 1e-12);
      const Rigid3 pose = some_pose(random);
      EXPECT_NEAR(segment_set_distance(moved(pose, a), moved(pose, b), options), distance, 1e-9);
      EXPECT_NEAR(SegmentSetMeasure(moved(pose, b), options).to(a, pose).distance, distance, 1e-9);
    }
  }
}

TEST(SegmentDistance, AgreesWithWalkingAlongTheSegments) {
  RandomStream random(3);
  int partly = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto a = messy_set(random, 1);
    const auto b = messy_set(random, 25);
    SegmentDistanceOptions options;
    options.max_distance_m = 0.3;
    const double distance = segment_to_set_distance(a[0], b, options);
    const double nominal = a[0].length() * 0.09;
    EXPECT_NEAR(distance, walked_distance(a[0], b, options), 2e-4 * nominal + 1e-12);
    partly += distance > 0.05 * nominal && distance < 0.95 * nominal ? 1 : 0;
  }
  EXPECT_GT(partly, 15);
}

TEST(SegmentDistance, FiveFragmentsCoverOneSegmentOnce) {
  const Segment whole = along_x(0.0, 5.0);
  std::vector<Segment> fragments;
  for (int i = 0; i < 5; ++i) fragments.push_back(along_x(i, i + 1.0));
  EXPECT_NEAR(segment_set_distance({whole}, fragments), 0.0, 1e-12);
  SegmentDistanceOptions relative;
  relative.weight = SegmentWeight::relative;
  EXPECT_NEAR(segment_to_set_distance(whole, fragments, relative), 0.0, 1e-12);
  // Four of them, one twice: a fifth of the length stays uncovered.
  fragments[4] = fragments[3];
  const double d2 = relative.max_distance_m * relative.max_distance_m;
  EXPECT_NEAR(segment_to_set_distance(whole, fragments, relative), d2 / 5.0, 1e-12);
  EXPECT_NEAR(segment_to_set_distance(whole, fragments), d2, 1e-12);
}

TEST(SegmentDistance, WholeSegmentsAsPrintedPunishFragments) {
  SegmentDistanceOptions printed;
  printed.whole_segments = true;
  const auto common = overlap_of(along_x(0.0, 5.0), along_x(0.0, 1.0), printed);
  ASSERT_TRUE(common);
  EXPECT_NEAR(common->distance_m, 1.0, 1e-12);  // one of the four ends lies 4 m away
  EXPECT_NEAR(overlap_of(along_x(0.0, 5.0), along_x(0.0, 1.0))->distance_m, 0.0, 1e-12);
}

TEST(SegmentDistance, TheWallsNormalCanBeTakenOut) {
  const std::vector<Segment> inside = {along_x(0.0, 2.0, 0.0), along_x(0.0, 2.0, 0.0, 1.5)};
  std::vector<Segment> outside = {along_x(0.0, 2.0, 0.4), along_x(0.0, 2.0, 0.4, 1.5)};
  SegmentDistanceOptions options;
  const double nominal = 8.0 * options.max_distance_m * options.max_distance_m;
  EXPECT_NEAR(segment_set_distance(inside, outside, options), nominal, 1e-12);
  options.wall_normal = Vector3d::UnitY();
  EXPECT_NEAR(segment_set_distance(inside, outside, options), 0.0, 1e-12);
  // A segment along the normal has no length left.
  outside.push_back({Vector3d(0.0, 0.0, 0.0), Vector3d(0.0, 1.0, 0.0)});
  EXPECT_NEAR(segment_set_distance(inside, outside, options), 0.0, 1e-12);
}

TEST(SegmentDistance, TellsHowMuchIsCovered) {
  const SegmentSetMeasure measure({along_x(0.0, 1.0), along_x(3.0, 5.0)}, {});
  const SetDistance result = measure.to({along_x(0.5, 4.0, 0.05)});
  EXPECT_NEAR(result.source_covered_m, 1.5, 1e-12);
  EXPECT_NEAR(result.target_covered_m, 1.5, 1e-12);
  EXPECT_LT(result.distance, result.nominal);
  EXPECT_EQ(SegmentSetMeasure({}, {}).to({}).nominal, 0.0);
}

}  // namespace
}  // namespace limen
