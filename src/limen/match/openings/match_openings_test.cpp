// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/match_openings.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/register/judge/verdict.h"
#include "limen/register/refine/measure_thickness.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {
namespace {

constexpr double kThickness = 0.4;
constexpr double kGateM = 0.25;

std::vector<OpeningMatch> match_openings(const Features& source, const Features& target, const Rigid3& pose) {
  return OpeningMatching(source, target).under(pose, kGateM);
}

/// A rectangle in a wall that faces the scanner with `normal`: lower left corner, width, height.
Opening rectangle(const Vector3d& corner, const Vector3d& across, double width, double height, int facade) {
  Opening opening;
  opening.corners[0] = corner;
  opening.corners[1] = corner + width * across;
  opening.corners[2] = corner + width * across + height * Vector3d::UnitZ();
  opening.corners[3] = corner + height * Vector3d::UnitZ();
  opening.facade = facade;
  for (double& sigma : opening.edge_sigma_m) sigma = 0.005;
  return opening;
}

PlanarPolygon wall(const Vector3d& normal, double offset) {
  PlanarPolygon polygon;
  polygon.plane = {normal, offset};
  polygon.oriented = true;
  polygon.inliers = 10000;
  polygon.rms_m = 0.003;
  return polygon;
}

/// Two walls of a house with a window each, seen from outside: outer faces y = 0 and x = 0.
Features outside() {
  Features features;
  features.planes = {wall(-Vector3d::UnitY(), 0.0), wall(-Vector3d::UnitX(), 0.0)};
  features.openings = {rectangle({2.0, 0.0, 1.0}, Vector3d::UnitX(), 1.2, 1.5, 0),
                       rectangle({0.0, 5.0, 1.0}, -Vector3d::UnitY(), 1.0, 1.5, 1)};
  return features;
}

/// The same from inside, `splay` wider left and right.
Features inside(double splay = 0.0) {
  Features features;
  features.planes = {wall(Vector3d::UnitY(), kThickness), wall(Vector3d::UnitX(), kThickness)};
  features.openings = {rectangle({3.2 + splay, kThickness, 1.0}, -Vector3d::UnitX(), 1.2 + 2 * splay, 1.5, 0),
                       rectangle({kThickness, 4.0 - splay, 1.0}, Vector3d::UnitY(), 1.0 + 2 * splay, 1.5, 1)};
  return features;
}

TEST(MatchOpenings, MeetsAcrossTheWall) {
  const Rigid3 off{Matrix3d::Identity(), {0.05, 0.02, -0.03}};
  const std::vector<OpeningMatch> matches = match_openings(inside(), outside(), off);
  ASSERT_EQ(matches.size(), 2U);
  for (const OpeningMatch& match : matches) {
    EXPECT_TRUE(match.opposite);
    EXPECT_EQ(match.source, match.target);
    EXPECT_NEAR(match.shift_up_m, 0.03, 0.003);
    const double expected = -match.across.dot(off.translation);
    EXPECT_NEAR(match.shift_across_m, expected, 1e-3);
    EXPECT_NEAR(match.gap_m, match.source == 0 ? 0.42 : 0.45, 1e-9);
  }
}

TEST(MatchOpenings, TheSplaySaysNothingOfThePose) {
  const std::vector<OpeningMatch> matches = match_openings(inside(0.06), outside(), {});
  ASSERT_EQ(matches.size(), 2U);
  for (const OpeningMatch& match : matches) {
    EXPECT_NEAR(match.shift_across_m, 0.0, 1e-6);
    EXPECT_LT(match.sigma_across_m, 0.01);
  }
}

/// The outline of an arched window in its rectangle: straight to `spring`, then half an ellipse.
void arch(Opening& opening, double spring) {
  const Vector3d side = opening.corners[1] - opening.corners[0];
  const Vector3d rise = opening.corners[3] - opening.corners[0];
  opening.outline = {opening.corners[0], opening.corners[1]};
  for (int k = 0; k <= 16; ++k) {
    const double angle = 3.14159265 * k / 16;
    opening.outline.push_back(opening.corners[0] + 0.5 * (1.0 + std::cos(angle)) * side +
                              (spring + (1.0 - spring) * std::sin(angle)) * rise);
  }
}

/// The outline of a round window in its rectangle.
void oval(Opening& opening) {
  const Vector3d side = 0.5 * (opening.corners[1] - opening.corners[0]);
  const Vector3d rise = 0.5 * (opening.corners[3] - opening.corners[0]);
  opening.outline.clear();
  for (int k = 0; k < 32; ++k) {
    const double angle = 3.14159265 * k / 16;
    opening.outline.push_back(opening.corners[0] + (1.0 + std::cos(angle)) * side +
                              (1.0 + std::sin(angle)) * rise);
  }
}

TEST(MatchOpenings, TheCrownOfAnArchHoldsTheHeight) {
  Features in = inside();
  Features out = outside();
  // Neither sill nor head has a straight edge that was seen.
  for (Features* side : {&in, &out}) {
    arch(side->openings[0], 0.6);
    side->openings[0].edge_sigma_m[0] = side->openings[0].edge_sigma_m[2] = 1.0;
  }
  const Rigid3 off{Matrix3d::Identity(), {0.0, 0.0, 0.05}};
  const std::vector<OpeningMatch> matches = match_openings(in, out, off);
  ASSERT_EQ(matches.size(), 2U);
  const OpeningMatch& match = matches[0].source == 0 ? matches[0] : matches[1];
  EXPECT_TRUE(match.by_outline);
  EXPECT_NEAR(match.shift_up_m, -0.05, 0.003);
  EXPECT_LT(match.sigma_up_m, 0.02);
}

TEST(MatchOpenings, OutlinesOfAnotherShapeContradict) {
  Features in = inside();
  Features out = outside();
  arch(in.openings[0], 0.6);
  arch(out.openings[0], 0.6);
  EXPECT_EQ(match_openings(in, out, {}).size(), 2U);
  // The same rectangle, bent all round.
  oval(out.openings[0]);
  const std::vector<OpeningMatch> matches = match_openings(in, out, {});
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].source, 1);
  EXPECT_FALSE(matches[0].by_outline);
}

TEST(MatchOpenings, OneSeenEdgeTellsLess) {
  Features source = inside();
  source.openings[0].edge_sigma_m[3] = 1.0;
  const std::vector<OpeningMatch> matches = match_openings(source, outside(), {});
  ASSERT_EQ(matches.size(), 2U);
  for (const OpeningMatch& match : matches) {
    if (match.source == 0) {
      EXPECT_GT(match.sigma_across_m, 0.03);
    } else {
      EXPECT_LT(match.sigma_across_m, 0.01);
    }
  }
}

TEST(MatchOpenings, NotBeyondTheGateNorFarApart) {
  EXPECT_TRUE(match_openings(inside(), outside(), {Matrix3d::Identity(), {0.4, 0.4, 0.0}}).empty());
  // A wall two metres thick is none, nor one turned inside out.
  EXPECT_TRUE(match_openings(inside(), outside(), {Matrix3d::Identity(), {2.0, 2.0, 0.0}}).empty());
  EXPECT_TRUE(match_openings(inside(), outside(), {Matrix3d::Identity(), {-0.6, -0.6, 0.0}}).empty());
}

TEST(MatchOpenings, SameFaceSeenTwice) {
  const std::vector<OpeningMatch> matches = match_openings(outside(), outside(), {});
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_FALSE(matches[0].opposite);
  EXPECT_NEAR(matches[0].gap_m, 0.0, 1e-9);
}

TEST(RefinePose, OpeningsOfTwoWallsHoldThePose) {
  const Features source = inside();
  const Features target = outside();
  const ScanView from{&source, nullptr};
  const ScanView to{&target, nullptr};
  const Rigid3 off{rotation_exp({0.0, 0.0, 0.01}), {0.05, -0.04, 0.06}};
  const RefinedPose pose = refine_pose(from, to, off, {});
  EXPECT_LT(pose.target_from_source.translation.norm(), 0.004);
  EXPECT_LT(rotation_angle(pose.target_from_source.rotation), 1e-3);
  EXPECT_TRUE(unobserved_freedoms(pose, 0.03).empty());
  const std::vector<MeasuredThickness> walls = measure_thickness(pose, source, target);
  ASSERT_EQ(walls.size(), 2U);
  for (const MeasuredThickness& measured : walls) {
    EXPECT_NEAR(measured.value_m, kThickness, 0.005);
    EXPECT_LT(std::abs(measured.value_m - kThickness), 3.0 * measured.sigma_m);
  }
}

TEST(RefinePose, OneWallLeavesItsNormalOpenUnlessTheThicknessIsKnown) {
  Features source = inside();
  Features target = outside();
  source.openings.resize(1);
  target.openings.resize(1);
  const ScanView from{&source, nullptr};
  const ScanView to{&target, nullptr};
  const Rigid3 off{Matrix3d::Identity(), {0.03, 0.1, 0.02}};
  const RefinedPose open = refine_pose(from, to, off, {});
  const std::vector<UnobservedFreedom> freedoms = unobserved_freedoms(open, 0.03);
  ASSERT_EQ(freedoms.size(), 1U);
  EXPECT_FALSE(freedoms[0].rotation);
  EXPECT_NEAR(std::abs(freedoms[0].direction.y()), 1.0, 1e-6);
  EXPECT_NEAR(open.target_from_source.translation.y(), 0.1, 1e-6);
  ASSERT_EQ(measure_thickness(open, source, target).size(), 1U);
  EXPECT_GT(measure_thickness(open, source, target)[0].sigma_m, 10.0);

  RefineOptions known;
  known.wall_thickness_m = kThickness;
  const RefinedPose held = refine_pose(from, to, off, known);
  EXPECT_TRUE(unobserved_freedoms(held, 0.03).empty());
  EXPECT_NEAR(held.target_from_source.translation.y(), 0.0, 1e-3);

  source.openings[0].reveal_depth_m = kThickness;
  source.openings[0].reveal_sigma_m = 0.004;
  source.openings[0].reveal_complete = true;
  const RefinedPose seen = refine_pose(from, to, off, {});
  EXPECT_NEAR(seen.target_from_source.translation.y(), 0.0, 1e-3);
}

}  // namespace
}  // namespace limen
