// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "support/synthetic_model.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/register/prepare/prepare_group.h"
#include "limen/register/register.h"
#include "limen/simulate/model/bim_recipe.h"
#include "limen/simulate/model/bim_scene.h"

namespace limen {
namespace {

/// A scan from the middle of the `room`-th of a row's rooms.
SimulatedCase scan_of(const BimModel& model, std::uint64_t seed, std::size_t stations = 1,
                      bool any_rotation = false) {
  BimSceneOptions options;
  options.seed = seed;
  options.stations = stations;
  options.points = 60000;
  options.any_rotation = any_rotation;
  return simulate_bim(model, options);
}

bool near(const Rigid3& pose, const Rigid3& truth) {
  return (pose.translation - truth.translation).norm() < 0.01 &&
         rotation_angle(pose.rotation.transpose() * truth.rotation) < radians(0.1);
}

bool lists(const RegistrationResult& result, const Rigid3& truth) {
  return near(result.best.target_from_source, truth) ||
         std::any_of(result.alternatives.begin(), result.alternatives.end(),
                     [&](const Hypothesis& h) { return near(h.target_from_source, truth); });
}

TEST(RegisterToModel, FindsTheRoom) {
  const BimModel model = row_of_rooms({5.0, 3.2, 6.5}, {2.0, 1.0, 4.0});
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SimulatedCase made = scan_of(model, seed, 1, seed == 2);
    const RegistrationResult result = register_to_model(made.scans[0], model);
    EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
    EXPECT_TRUE(near(result.best.target_from_source, world_from_scan(made.truth, 0))) << "seed " << seed;
    EXPECT_GT(result.best.explained_share.value(), 0.9);
  }
}

TEST(RegisterToModel, ModelMayBeTheSource) {
  const BimModel model = row_of_rooms({5.0, 3.2}, {2.0, 1.0});
  const SimulatedCase made = scan_of(model, 4);
  RegisterInput source;
  source.model = model;
  RegisterInput target;
  target.scans.push_back({made.scans[0], {}});
  const RegistrationResult result = register_inputs(source, target);
  EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_TRUE(near(inverse(result.best.target_from_source), world_from_scan(made.truth, 0)));
}

TEST(RegisterToModel, RoomsAlikeAreAllNamed) {
  const BimModel model = row_of_rooms({4.0, 4.0, 4.0, 6.0}, {1.0, 1.0, 1.0, 2.0});
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const SimulatedCase made = scan_of(model, seed);
    const Rigid3 truth = world_from_scan(made.truth, 0);
    const RegistrationResult result = register_to_model(made.scans[0], model);
    EXPECT_TRUE(lists(result, truth)) << "seed " << seed;
    const bool one_of_three = (truth * Vector3d::Zero()).x() < 12.4;
    if (!one_of_three) {
      EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
      continue;
    }
    EXPECT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
    for (const double shift : {-8.4, -4.2, 4.2, 8.4}) {
      Rigid3 other = truth;
      other.translation.x() += shift;
      const double x = other.translation.x();
      if (x < 0 || x > 12.4) continue;
      EXPECT_TRUE(lists(result, other)) << "seed " << seed << " shift " << shift;
    }
  }
}

TEST(RegisterToModel, WhatIsNotInTheModelIsNotRegistered) {
  // All rooms are as deep and as high as those of the model, so that three walls of four can be met.
  const BimModel model = row_of_rooms({5.0, 3.2}, {2.0, 1.0});
  const BimModel other = row_of_rooms({4.1, 7.3}, {1.5, 0.0});
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const SimulatedCase made = scan_of(other, seed);
    const RegistrationResult result = register_to_model(made.scans[0], model);
    EXPECT_NE(result.outcome, Outcome::registered) << "seed " << seed << ": " << result.reason;
  }
}

TEST(RegisterToModel, AnotherBuildingIsNoMatch) {
  BimModel model = row_of_rooms({5.0, 3.2}, {2.0, 1.0});
  // The same, 1.3 times as large.
  for (BimFace& face : model.faces) {
    face.plane.offset *= 1.3;
    face.frame.origin *= 1.3;
    for (Vector2d& p : face.outline.outer) p *= 1.3;
    face.area_m2 *= 1.69;
  }
  const SimulatedCase made = scan_of(row_of_rooms({4.1, 7.3}, {1.5, 0.0}), 1);
  const RegistrationResult result = register_to_model(made.scans[0], model);
  EXPECT_EQ(result.outcome, Outcome::no_match) << result.reason;
}

TEST(RegisterToModel, AMergedCloudOfTwoStoreysIsNotTakenForThoseAbove) {
  const BimModel model = model_of(office_recipe());
  BimSceneOptions options;
  options.seed = 31;
  options.stations = 6;
  options.points = 120000;
  options.room = RoomChoice::each;
  const SimulatedCase made = simulate_bim(model, options);
  // Nobody says from where its points were seen. Walls of storeys are in line.
  Scan merged;
  for (std::size_t k = 0; k < made.scans.size(); ++k) {
    const Rigid3 pose = world_from_scan(made.truth, k);
    for (const Vector3d& x : made.scans[k].points)
      merged.points.push_back(pose * (x + made.scans[k].local_origin));
  }
  EXPECT_TRUE(near(register_to_model(merged, model).best.target_from_source, Rigid3{}));
}

TEST(RegisterToModel, StationsKnownToOneAnotherActTogether) {
  const BimModel model = row_of_rooms({5.0, 3.2, 6.5}, {2.0, 1.0, 4.0});
  const SimulatedCase made = scan_of(model, 5, 3, true);
  ASSERT_EQ(made.scans.size(), 3U);
  RegisterInput source;
  for (std::size_t i = 0; i < 3; ++i)
    source.scans.push_back({made.scans[i], true_target_from_source(made.truth, i, 0)});
  RegisterInput target;
  target.model = model;
  const RegistrationResult result = register_inputs(source, target);
  EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_TRUE(near(result.best.target_from_source, world_from_scan(made.truth, 0)));
}

TEST(RegisterToModel, BySegments) {
  const BimModel model = row_of_rooms({5.0, 3.2, 6.5}, {2.0, 1.0, 4.0});
  const SimulatedCase made = scan_of(model, 6);
  RegisterOptions options;
  options.method = Method::segments;
  const RegistrationResult result = register_to_model(made.scans[0], model, options);
  EXPECT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_TRUE(near(result.best.target_from_source, world_from_scan(made.truth, 0)));
}

TEST(RegisterToModel, TwoModelsAreRefused) {
  RegisterInput side;
  side.model = row_of_rooms({5.0});
  EXPECT_THROW(register_inputs(side, side), Error);
}

TEST(PrepareGroup, SurfacesSeenTwiceAreOne) {
  const BimModel model = row_of_rooms({5.0}, {2.0});
  const SimulatedCase made = scan_of(model, 1, 3);
  std::vector<PlacedScan> scans;
  for (std::size_t i = 0; i < made.scans.size(); ++i)
    scans.push_back({made.scans[i], true_target_from_source(made.truth, i, 0)});
  const PreparedScan alone = prepare_group({scans[0]});
  const PreparedScan all = prepare_group(scans);
  EXPECT_EQ(all.stations.size(), 3U);
  EXPECT_TRUE(all.upright);
  EXPECT_LE(all.extracted.features.planes.size(), alone.extracted.features.planes.size() + 3);
  for (std::size_t k = 1; k < all.extracted.features.samples.size(); ++k) {
    EXPECT_LE(static_cast<std::uint32_t>(all.extracted.features.samples[k - 1].plane),
              static_cast<std::uint32_t>(all.extracted.features.samples[k].plane));
  }
  EXPECT_THROW(prepare_group({}), Error);
}

}  // namespace
}  // namespace limen
