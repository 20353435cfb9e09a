// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/published/register_published.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/register/published/published_pose.h"
#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

/// Two scans of which the source is nearly in place already.
struct PublishedPair {
  Scan source;
  Scan target;
  Rigid3 truth;  // target from source, world

  [[nodiscard]] Vector3d station() const { return source.centre(0) + source.local_origin; }
};

/// The source where it belongs, but for a turn about its station and a shift.
PublishedPair nearly_placed(const SceneOptions& scene, double shift_m, double turn_deg) {
  const SimulatedCase made = simulate(scene);
  const std::size_t target = made.scans.size() - 1;
  const Rigid3 truth = true_target_from_source(made.truth, 0, target);
  PublishedPair pair{made.scans[0], made.scans[target], {}};
  const Vector3d station = truth * pair.station();
  const Matrix3d turn = rotation_exp(radians(turn_deg) * Vector3d(1.0, 2.0, 3.0).normalized());
  const Vector3d shift = shift_m * Vector3d(2.0, -1.0, 0.5).normalized();
  const Rigid3 off{turn, station - turn * station + shift};
  const Rigid3 placed = off * truth;
  pair.source.local_origin = placed * pair.source.local_origin;
  for (Vector3d& x : pair.source.points) x = placed.rotation * x;
  for (Vector3d& x : pair.source.centres) x = placed.rotation * x;
  pair.truth = inverse(off);
  return pair;
}

PublishedPair room(double shift_m, double turn_deg) {
  SceneOptions scene;
  scene.name = "room";
  scene.seed = 3;
  scene.stations = 2;
  scene.points_indoor = 40000;
  PublishedPair pair = nearly_placed(scene, shift_m, turn_deg);
  return pair;
}

RegistrationResult published(const PublishedPair& pair, PublishedMethod method) {
  RegisterOptions options;
  options.as_published = method;
  return register_scans(pair.source, pair.target, options);
}

Vector3d off(const PublishedPair& pair, const RegistrationResult& result) {
  return result.best.target_from_source * pair.station() - pair.truth * pair.station();
}

double turn_deg(const PublishedPair& pair, const RegistrationResult& result) {
  return degrees(rotation_angle(pair.truth.rotation.transpose() * result.best.target_from_source.rotation));
}

TEST(Published, ClustersOf2021FindAPoseFromTheThirdStartOfTable1) {
  const PublishedPair pair = room(1.27, 3.0);
  const RegistrationResult result = published(pair, PublishedMethod::cluster_2021);
  ASSERT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
  EXPECT_LT(off(pair, result).norm(), 0.05);
  EXPECT_LT(turn_deg(pair, result), 1.0);
  ASSERT_TRUE(result.published);
  EXPECT_EQ(result.published->method, "2021-cluster");
  EXPECT_GT(result.published->value, 10.0);
  EXPECT_GT(result.published->hypotheses, 100U);
  EXPECT_GT(result.best.agreeing_m2, 10.0);
}

TEST(Published, ThresholdsOf2021NeedAGoodStart) {
  const PublishedPair near = room(0.099, 0.001);
  const RegistrationResult good = published(near, PublishedMethod::threshold_2021);
  ASSERT_EQ(good.outcome, Outcome::ambiguous) << good.reason;
  EXPECT_LT(off(near, good).norm(), 0.05);
  const PublishedPair far = room(4.15, 12.0);
  const RegistrationResult bad = published(far, PublishedMethod::threshold_2021);
  EXPECT_NE(bad.outcome, Outcome::registered);
  EXPECT_TRUE(bad.outcome == Outcome::no_match || off(far, bad).norm() > 0.2);
}

TEST(Published, SegmentsOf2023) {
  const PublishedPair pair = room(0.44, 0.528);
  const RegistrationResult result = published(pair, PublishedMethod::segments_2023);
  ASSERT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
  EXPECT_LT(off(pair, result).norm(), 0.1);
  EXPECT_TRUE(result.published->lower_is_better);
}

constexpr double kThickness = 0.4;

/// An upright rectangle in a wall: its lower left corner as its scanner sees it.
Opening window(const Vector3d& corner, const Vector3d& across, double width, double height) {
  Opening opening;
  opening.corners[0] = corner;
  opening.corners[1] = corner + width * across;
  opening.corners[2] = opening.corners[1] + height * Vector3d::UnitZ();
  opening.corners[3] = corner + height * Vector3d::UnitZ();
  for (double& sigma : opening.edge_sigma_m) sigma = 0.005;
  return opening;
}

/// Three windows of a façade, no two alike: x of the left side, sill, width and height.
constexpr double kWindows[3][4] = {{0.0, 0.9, 1.2, 1.5}, {2.1, 0.9, 0.8, 1.5}, {4.5, 0.4, 1.6, 2.0}};

/// The façade y = 0 from outside, y < 0.
Features facade() {
  Features features;
  for (const auto& w : kWindows)
    features.openings.push_back(window({w[0], 0.0, w[1]}, Vector3d::UnitX(), w[2], w[3]));
  return features;
}

/// The same wall's inner face, y = 0.4, with a floor and a side wall across it.
Features room_behind() {
  Features features;
  for (const auto& w : kWindows)
    features.openings.push_back(window({w[0] + w[2], kThickness, w[1]}, -Vector3d::UnitX(), w[2], w[3]));
  for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
    PlanarPolygon plane;
    plane.plane = {normal, 0.0};
    plane.inliers = 1000;
    features.planes.push_back(plane);
  }
  return features;
}

TEST(Published, OpeningsLayTheFacesOfTheWallOnEachOther) {
  const Features inside = room_behind();
  const Features outside = facade();
  PublishedInput input{inside, outside};
  input.target_outside = true;
  input.upright = true;
  for (const PublishedAnswer& answer : {register_openings_2022(input), register_hybrid_2023(input)}) {
    ASSERT_TRUE(answer.pose) << answer.why_none;
    // Across the wall by its thickness, as printed, and said to be open; within it right.
    EXPECT_LT((answer.pose->target_from_source.translation - Vector3d(0.0, -kThickness, 0.0)).norm(), 1e-6);
    EXPECT_LT(rotation_angle(answer.pose->target_from_source.rotation), 1e-6);
    EXPECT_LT(answer.pose->criterion, 1e-6);
    ASSERT_EQ(answer.pose->not_held.size(), 1U);
    EXPECT_NEAR(std::abs(answer.pose->not_held[0].y()), 1.0, 1e-9);
  }
}

TEST(Published, AKnownThicknessHoldsTheHybrid) {
  const Features inside = room_behind();
  const Features outside = facade();
  PublishedInput input{inside, outside};
  input.target_outside = true;
  input.upright = true;
  input.wall_thickness_m = kThickness;
  const PublishedAnswer answer = register_hybrid_2023(input);
  ASSERT_TRUE(answer.pose) << answer.why_none;
  EXPECT_LT(answer.pose->target_from_source.translation.norm(), 1e-6);
  EXPECT_TRUE(answer.pose->not_held.empty());
}

TEST(Published, TheSameForAnyNumberOfThreadsAndAnotherForAnotherSeed) {
  const PublishedPair pair = room(0.44, 0.528);
  RegisterOptions options;
  options.as_published = PublishedMethod::segments_2023;
  const int threads = thread_count();
  set_thread_count(1);
  const RegistrationResult one = register_scans(pair.source, pair.target, options);
  set_thread_count(3);
  const RegistrationResult three = register_scans(pair.source, pair.target, options);
  set_thread_count(threads);
  EXPECT_EQ(to_matrix(one.best.target_from_source), to_matrix(three.best.target_from_source));
  options.seed = 2;
  const RegistrationResult other = register_scans(pair.source, pair.target, options);
  EXPECT_NE(to_matrix(one.best.target_from_source), to_matrix(other.best.target_from_source));
}

TEST(Published, MethodsForScansRefuseAModel) {
  for (const auto& [method, name] : kPublishedMethods) {
    if (method == PublishedMethod::segments_2023) {
      EXPECT_NO_THROW(check_sides(method, true));
    } else {
      EXPECT_THROW(check_sides(method, true), Error);
    }
    EXPECT_NO_THROW(check_sides(method, false));
  }
}

}  // namespace
}  // namespace limen
