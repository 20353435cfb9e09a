// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/register_segments.h"

#include <limits>

#include "support/synthetic_segments.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

/// A room of a building, as a detector sees it, in national coordinates and any rotation.
struct Case {
  SegmentSet source;
  SegmentSet target;
  Rigid3 truth;  // world
};

Case room_case(std::uint64_t seed) {
  RandomStream random(43, seed);
  const auto rooms = synthetic::random_building(2, 3, 2, random);
  const Rigid3 local{synthetic::random_rotation(random), Vector3d(4, -7, 2)};
  const auto& room = rooms[random.below(static_cast<std::uint32_t>(rooms.size()))];
  Case it;
  it.source = {Vector3d(10, 20, 30), synthetic::moved(synthetic::detect(room, {}, random), inverse(local))};
  it.target = {Vector3d(1050000, 6840000, 140), synthetic::joined(rooms)};
  it.truth = to_world(local, it.source.local_origin, it.target.local_origin);
  return it;
}

/// How far a pose puts the middle of a set from where the truth puts it.
double shift_error(const Rigid3& pose, const Case& it) {
  const Vector3d middle = it.source.local_origin + extent_of({it.source.segments[0].a}).low;
  const Rigid3 a = to_local(pose, it.source.local_origin, it.target.local_origin);
  const Rigid3 b = to_local(it.truth, it.source.local_origin, it.target.local_origin);
  return (a * (middle - it.source.local_origin) - b * (middle - it.source.local_origin)).norm();
}

TEST(RegisterSegments, ARoomInABuilding) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Case it = room_case(seed);
    const RegistrationResult result = register_segments(it.source, it.target);
    EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
    EXPECT_LT(shift_error(result.best.target_from_source, it), 0.02);
    EXPECT_GT(result.best.matched_segments, 10);
    EXPECT_GT(result.sigma.translation_m.minCoeff(), 2e-4);
    EXPECT_LT(result.sigma.translation_m.maxCoeff(), 0.02);
  }
}

TEST(RegisterSegments, TheOtherWayRoundIsTheInverse) {
  const Case it = room_case(2);
  const Rigid3 there = register_segments(it.source, it.target).best.target_from_source;
  const RegistrationResult back = register_segments(it.target, it.source);
  const Rigid3 round =
      to_local(back.best.target_from_source, it.target.local_origin, it.source.local_origin) *
      to_local(there, it.source.local_origin, it.target.local_origin);
  EXPECT_LT(round.translation.norm(), 1e-6);
  EXPECT_LT(rotation_angle(round.rotation), 1e-9);
  // The best known place lies among the source's segments, which are the target now.
  EXPECT_LT((back.sigma.centre - it.source.local_origin).norm(), 40.0);
}

TEST(RegisterSegments, DeviationsCoverTheErrors) {
  double squares = 0.0;
  int count = 0;
  for (std::uint64_t seed = 20; seed < 32; ++seed) {
    const Case it = room_case(seed);
    const RegistrationResult result = register_segments(it.source, it.target);
    if (result.outcome != Outcome::registered) continue;
    const Rigid3 pose =
        to_local(result.best.target_from_source, it.source.local_origin, it.target.local_origin);
    const Rigid3 truth = to_local(it.truth, it.source.local_origin, it.target.local_origin);
    const Vector3d centre = result.sigma.centre - it.target.local_origin;
    const Vector3d off = pose * (inverse(truth) * centre) - centre;
    squares += off.cwiseQuotient(result.sigma.translation_m).squaredNorm() / 3.0;
    ++count;
  }
  ASSERT_GE(count, 10);
  const double rms = std::sqrt(squares / count);
  EXPECT_LT(rms, 1.3);
  EXPECT_GT(rms, 0.3);
}

TEST(RegisterSegments, ABoxTurnedByHalfIsTheSameBox) {
  std::vector<Segment> box;
  synthetic::add_box({0, 0, 0}, {5, 4, 3}, box);
  for (const Gravity gravity : {Gravity::automatic, Gravity::up, Gravity::unknown}) {
    const RegistrationResult result =
        register_segments({Vector3d::Zero(), box}, {Vector3d::Zero(), box}, gravity);
    EXPECT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
    std::size_t equal = 0;
    for (const Hypothesis& other : result.alternatives)
      equal += other.score > 0.99 * result.best.score ? 1 : 0;
    EXPECT_EQ(equal, gravity == Gravity::unknown ? 3U : 1U);
  }
}

TEST(RegisterSegments, AnUprightPoseIsBelievedOnlyIfItIsAsGood) {
  // A set whose y axis points up: most of it is vertical or level, but z is not up in both.
  RandomStream random(6);
  const auto room = synthetic::random_room({0, 0, 0}, {5, 4, 2.7}, random);
  const Rigid3 tilted{rotation_exp({radians(90.0), 0, 0}), Vector3d::Zero()};
  const RegistrationResult result = register_segments(
      {Vector3d::Zero(), synthetic::moved(room, inverse(tilted))}, {Vector3d::Zero(), room});
  EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_LT(rotation_angle(result.best.target_from_source.rotation.transpose() * tilted.rotation), 1e-3);
}

TEST(RegisterSegments, ARoomThatOccursTwiceIsAmbiguousWithBothListed) {
  RandomStream random(12);
  const auto rooms = synthetic::random_building(1, 2, 2, random);
  std::vector<Segment> model = synthetic::joined(rooms);
  const Rigid3 copy{synthetic::random_heading(random), Vector3d(40, 5, 0)};
  for (const Segment& edge : synthetic::moved(model, copy)) model.push_back(edge);
  const auto scan = synthetic::detect(rooms[1], {}, random);
  const RegistrationResult result = register_segments({Vector3d::Zero(), scan}, {Vector3d::Zero(), model});
  EXPECT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
  ASSERT_FALSE(result.alternatives.empty());
  const Vector3d at = scan[0].a;
  const Rigid3& first = result.best.target_from_source;
  const Rigid3& second = result.alternatives.front().target_from_source;
  const bool first_is_original = (first * at - at).norm() < 0.05;
  EXPECT_LT(((first_is_original ? first : second) * at - at).norm(), 0.05);
  EXPECT_LT(((first_is_original ? second : first) * at - copy * at).norm(), 0.05);
}

TEST(RegisterSegments, ParallelSegmentsAreUnderConstrained) {
  RandomStream random(8);
  std::vector<Segment> poles;
  for (int i = 0; i < 12; ++i) {
    const Vector3d foot(random.uniform(0, 12), random.uniform(0, 9), 0.0);
    poles.push_back({foot, foot + Vector3d(0, 0, random.uniform(2, 3))});
  }
  const Rigid3 truth{synthetic::random_heading(random), Vector3d(3, 2, 1)};
  const RegistrationResult result = register_segments(
      {Vector3d::Zero(), poles}, {Vector3d::Zero(), synthetic::moved(poles, truth)}, Gravity::up);
  EXPECT_EQ(result.outcome, Outcome::under_constrained) << result.reason;
  ASSERT_EQ(result.unobserved.size(), 1U);
  EXPECT_FALSE(result.unobserved[0].rotation);
  EXPECT_GT(std::abs(result.unobserved[0].direction.z()), 0.999);
  const Vector3d off = result.best.target_from_source * poles[0].a - truth * poles[0].a;
  EXPECT_LT(off.head<2>().norm(), 0.01);
}

TEST(RegisterSegments, AnotherBuildingIsNotRegistered) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RandomStream random(77, seed);
    const auto here = synthetic::random_building(1, 2, 2, random);
    const auto elsewhere = synthetic::random_building(1, 2, 2, random);
    const RegistrationResult result =
        register_segments({Vector3d::Zero(), synthetic::detect(here[0], {}, random)},
                          {Vector3d::Zero(), synthetic::joined(elsewhere)});
    EXPECT_NE(result.outcome, Outcome::registered) << result.reason;
    EXPECT_NE(result.outcome, Outcome::under_constrained) << result.reason;
  }
}

TEST(RegisterSegments, TheSameForAnyThreads) {
  const Case it = room_case(4);
  set_thread_count(1);
  const RegistrationResult one = register_segments(it.source, it.target);
  set_thread_count(3);
  const RegistrationResult three = register_segments(it.source, it.target);
  set_thread_count(0);
  EXPECT_EQ(to_matrix(one.best.target_from_source), to_matrix(three.best.target_from_source));
  EXPECT_EQ(one.sigma.translation_m, three.sigma.translation_m);
  EXPECT_EQ(one.alternatives.size(), three.alternatives.size());
}

TEST(RegisterSegments, NothingAndNonsense) {
  const SegmentSet empty;
  EXPECT_EQ(register_segments(empty, empty).outcome, Outcome::no_match);
  SegmentSet bad;
  bad.segments.push_back({Vector3d::Zero(), Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())});
  EXPECT_THROW((void)register_segments(bad, bad), Error);
}

}  // namespace
}  // namespace limen
