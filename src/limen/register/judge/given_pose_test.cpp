// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/given_pose.h"

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

/// Two scans of one room, one of them turned any way round.
struct TwoScans {
  PreparedScan source;
  PreparedScan target;
  Rigid3 truth;

  TwoScans() {
    SceneOptions options;
    options.name = "room";
    options.seed = 3;
    options.points_indoor = 60000;
    SimulatedCase simulated = simulate(options);
    RandomStream stream(99, 1);
    const Rigid3 moved{uniform_rotation(stream), {3.0, -2.0, 1.0}};
    Scan& scan = simulated.scans.at(0);
    for (Vector3d& x : scan.points) x = moved * x;
    for (Vector3d& x : scan.centres) x = moved * x;
    truth = true_target_from_source(simulated.truth, 0, 1) * inverse(moved);
    source = prepare_scan(scan);
    target = prepare_scan(simulated.scans.at(1));
  }
};

TEST(GivenPose, TheRightPoseAgreesAndAnotherIsContradicted) {
  const TwoScans scans;
  const PoseScore right = score_given_pose(scans.source, scans.target, scans.truth);
  EXPECT_GT(right.agreeing_m2, 5.0);
  EXPECT_LT(right.contradicted_m2, 0.05 * right.agreeing_m2);
  Rigid3 off = scans.truth;
  off.translation.x() += 1.1;
  const PoseScore wrong = score_given_pose(scans.source, scans.target, off);
  EXPECT_GT(wrong.contradicted_m2, 1.0);
  EXPECT_LT(wrong.value(), right.value());
}

/// A pose that is known to a decimetre only contradicts less than one that is known to a centimetre.
TEST(GivenPose, WhatIsKnownLessWellContradictsLess) {
  const TwoScans scans;
  Rigid3 off = scans.truth;
  off.translation.x() += 0.15;
  const PoseScore sharp = score_given_pose(scans.source, scans.target, off);
  const PoseScore loose = score_given_pose(scans.source, scans.target, off, Method::automatic, 0.1);
  EXPECT_GT(sharp.contradicted_m2, 2.0 * loose.contradicted_m2);
  EXPECT_GT(loose.agreeing_m2, sharp.agreeing_m2);
}

TEST(GivenPose, ThingsThatMeetAreEvidenceAgainstALookAlike) {
  const TwoScans scans;
  Rigid3 off = scans.truth;
  off.translation.x() += 1.1;
  EXPECT_LT(probability_of(look_alike_of_given_pose(scans.source, scans.target, scans.truth)),
            probability_of(look_alike_of_given_pose(scans.source, scans.target, off)));
}

}  // namespace
}  // namespace limen
