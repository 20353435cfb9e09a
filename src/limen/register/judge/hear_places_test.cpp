// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/hear_places.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

/// A pose that a wall and a floor and much else hold, `shift_m` along the building.
JudgedPose pose_at(double shift_m, double agreeing_m2) {
  JudgedPose pose;
  pose.refined.target_from_source.translation = {shift_m, 0.0, 0.0};
  pose.refined.geometry_m2 = agreeing_m2 * Matrix6d::Identity();
  pose.refined.information = 1e8 * Matrix6d::Identity();
  pose.score.agreeing_m2 = pose.score.planar_m2 = pose.score.evidence_m2 = agreeing_m2;
  return pose;
}

/// Of `count` things so many agree as `share` tells, as in a room where few would by chance.
IndividualMatter things(double count, double share) {
  IndividualMatter matter;
  matter.matter = {count, share};
  matter.chance = 0.05;
  matter.apart = true;
  for (int k = 0; share > 0.5 && k < 12; ++k)
    matter.faces.push_back({.offset_m = 0.0, .sigma_m = 0.001, .thing = k});
  return matter;
}

struct Heard {
  std::optional<HeardPlaces> places;
  int asked = 0;
};

/// The place 0 m along through a door, the place 10 m along built alike.
Heard hear(const IndividualMatter& of_the_door, const IndividualMatter& of_the_other, double door_m2 = 14.0) {
  const std::vector<JudgedPose> poses = {pose_at(0.0, door_m2), pose_at(10.0, 40.0)};
  const ContrastFunction contrast = [&](std::size_t a, std::size_t b) {
    return PoseContrast{poses[a].score.agreeing_m2, poses[b].score.agreeing_m2};
  };
  Heard heard;
  const MatterFunction matter = [&](const RefinedPose& pose) {
    ++heard.asked;
    return pose.target_from_source.translation.x() > 5.0 ? of_the_other : of_the_door;
  };
  heard.places = hear_past_twins(poses, judge(poses, contrast), contrast, matter, {});
  return heard;
}

TEST(HearPlaces, ThingsSeenThroughADoorTellMoreThanTheWallsOfATwin) {
  const Heard heard = hear(things(20.0, 1.0), things(20.0, 0.1));
  ASSERT_TRUE(heard.places);
  ASSERT_EQ(heard.places->verdict.ranking, std::vector<std::size_t>{0});
  EXPECT_EQ(heard.places->verdict.outcome, Outcome::registered) << heard.places->verdict.reason;
  ASSERT_EQ(heard.places->twins.size(), 1U);
  EXPECT_EQ(heard.places->twins[0].pose, 1U);
  EXPECT_GT(heard.places->twins[0].said.probability(), 0.5);
}

TEST(HearPlaces, BareWallsAreLeftToTheirSurface) {
  EXPECT_FALSE(hear(things(0.0, 0.0), things(0.0, 0.0)).places);
  EXPECT_FALSE(hear(things(0.0, 0.0), things(20.0, 1.0)).places);
}

TEST(HearPlaces, WhatMayMeetByChanceIsNotHeard) {
  EXPECT_FALSE(hear(things(20.0, 1.0), things(20.0, 0.1), 5.0).places);
}

}  // namespace
}  // namespace limen
