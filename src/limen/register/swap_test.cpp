// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Which side is called the source must not change an answer: swapped sides have the inverse pose, and all
// else the other way round.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

std::vector<Scan> scans_of(const std::string& scene, std::uint64_t seed, std::size_t stations = 0) {
  SceneOptions options;
  options.name = scene;
  options.seed = seed;
  options.points_indoor = 60000;
  options.points_outdoor = 200000;
  options.stations = stations;
  options.as_built = true;
  return simulate(options).scans;
}

/// That one pose is the other's inverse, with the same covariance: of turns and shifts about one point.
void expect_inverse(const Hypothesis& forth, const Hypothesis& back) {
  const Rigid3 loop = back.target_from_source * forth.target_from_source;
  EXPECT_LT((loop.rotation - Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_LT(loop.translation.norm(), 1e-8);
  EXPECT_LT((back.target_from_source * forth.sigma.centre - back.sigma.centre).norm(), 1e-8);
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = back.target_from_source.rotation;
  const Matrix6d moved = turn * forth.sigma.covariance * turn.transpose();
  // Along what nothing holds a covariance is a bound and no measure: 1e6 m^2.
  if (moved.norm() < 1.0) {
    EXPECT_LT((moved - back.sigma.covariance).norm(), 1e-6 * moved.norm());
  }
  EXPECT_EQ(forth.probability.has_value(), back.probability.has_value());
  EXPECT_EQ(forth.probability.value_or(0.0), back.probability.value_or(0.0));
  EXPECT_EQ(forth.score, back.score);
  EXPECT_EQ(forth.agreeing_m2, back.agreeing_m2);
  EXPECT_EQ(forth.contradicted_m2, back.contradicted_m2);
  EXPECT_EQ(forth.tie, back.tie);
  EXPECT_EQ(forth.room, back.room);
}

void expect_swapped_lists(const RegistrationResult& forth, const RegistrationResult& back) {
  ASSERT_EQ(forth.matches.size(), back.matches.size());
  for (std::size_t k = 0; k < forth.matches.size(); ++k) {
    EXPECT_EQ(forth.matches[k].source, back.matches[k].target);
    EXPECT_EQ(forth.matches[k].target, back.matches[k].source);
    EXPECT_EQ(forth.matches[k].distance_m, -back.matches[k].distance_m);
    EXPECT_EQ(forth.matches[k].overlap_m2, back.matches[k].overlap_m2);
  }
  ASSERT_EQ(forth.openings.size(), back.openings.size());
  for (std::size_t k = 0; k < forth.openings.size(); ++k) {
    EXPECT_EQ(forth.openings[k].source, back.openings[k].target);
    EXPECT_EQ(forth.openings[k].target, back.openings[k].source);
    EXPECT_EQ(forth.openings[k].shift_up_m, -back.openings[k].shift_up_m);
    EXPECT_EQ(std::abs(forth.openings[k].shift_across_m), std::abs(back.openings[k].shift_across_m));
  }
  ASSERT_EQ(forth.thickness.size(), back.thickness.size());
  for (std::size_t k = 0; k < forth.thickness.size(); ++k) {
    EXPECT_EQ(forth.thickness[k].source_plane, back.thickness[k].target_plane);
    EXPECT_EQ(forth.thickness[k].value_m, back.thickness[k].value_m);
    EXPECT_EQ(forth.thickness[k].sigma_m, back.thickness[k].sigma_m);
  }
  ASSERT_EQ(forth.unobserved.size(), back.unobserved.size());
  for (std::size_t k = 0; k < forth.unobserved.size(); ++k) {
    EXPECT_EQ(forth.unobserved[k].rotation, back.unobserved[k].rotation);
    const Vector3d turned = back.best.target_from_source.rotation * forth.unobserved[k].direction;
    EXPECT_NEAR(std::abs(turned.dot(back.unobserved[k].direction)), 1.0, 1e-6);
  }
}

RegistrationResult swaps(const Scan& source, const Scan& target) {
  const RegistrationResult forth = register_scans(source, target);
  const RegistrationResult back = register_scans(target, source);
  EXPECT_EQ(forth.outcome, back.outcome) << forth.reason << " / " << back.reason;
  EXPECT_EQ(forth.rivals, back.rivals);
  EXPECT_EQ(forth.judged_poses, back.judged_poses);
  expect_inverse(forth.best, back.best);
  EXPECT_EQ(forth.alternatives.size(), back.alternatives.size());
  for (std::size_t k = 0; k < std::min(forth.alternatives.size(), back.alternatives.size()); ++k)
    expect_inverse(forth.alternatives[k], back.alternatives[k]);
  expect_swapped_lists(forth, back);
  EXPECT_EQ(forth.others.has_value(), back.others.has_value());
  if (forth.others && back.others) {
    EXPECT_EQ(forth.others->nothing_shared, back.others->nothing_shared);
    EXPECT_EQ(forth.others->look_alike, back.others->look_alike);
    EXPECT_EQ(forth.others->unlisted_pose, back.others->unlisted_pose);
  }
  return forth;
}

TEST(Swap, OneRoom) {
  const std::vector<Scan> scans = scans_of("room", 5);
  EXPECT_EQ(swaps(scans.at(0), scans.at(1)).outcome, Outcome::registered);
}

TEST(Swap, TwoRooms) {
  const std::vector<Scan> scans = scans_of("flat", 2, 3);
  for (std::size_t k = 1; k < scans.size(); ++k) swaps(scans[0], scans[k]);
}

TEST(Swap, NothingShared) {
  EXPECT_EQ(swaps(scans_of("room", 3).at(0), scans_of("room", 8).at(1)).outcome, Outcome::no_match);
}

TEST(Swap, RoomAndStreet) {
  const std::vector<Scan> scans = scans_of("townhouse", 1);
  EXPECT_FALSE(swaps(scans.front(), scans.back()).openings.empty());
}

}  // namespace
}  // namespace limen
