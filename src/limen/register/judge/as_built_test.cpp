// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/as_built.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"

namespace limen {
namespace {

/// How a room was built and scanned.
struct Made {
  std::size_t surfaces = 14;
  double offset_m = 0.006;  ///< from what was drawn
  double turn_rad = radians(0.3);
  double noise = 1.0;           ///< times what a good scanner leaves
  bool look_alike = false;      ///< the source is another room
  bool bays = false;            ///< of which only what lies across the row is another
  bool turns_are_known = true;  ///< else only offsets are
};

constexpr double kNoiseM = 0.0007;
constexpr double kNoiseRad = radians(0.02);

Vector3d deviation(RandomStream& random, double offset_m, double turn_rad) {
  return {offset_m * random.normal(), turn_rad * random.normal(), turn_rad * random.normal()};
}

/// Floor, ceiling and walls, reveals, columns along the square, in turns.
std::vector<CommonSurface> scanned(const Made& made, std::uint64_t seed) {
  RandomStream random(seed, 0);
  std::vector<CommonSurface> surfaces;
  for (std::size_t i = 0; i < made.surfaces; ++i) {
    CommonSurface one;
    const std::size_t axis = i % 3;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    one.normal = side * Matrix3d::Identity().col(static_cast<Eigen::Index>(axis));
    one.at = 3.0 * Vector3d(random.normal(), random.normal(), random.normal());
    const Vector3d first = axis == 2 ? Vector3d::UnitX() : Vector3d(Vector3d::UnitZ().cross(one.normal));
    one.along = {first, one.normal.cross(first)};
    one.length_m = {2.5, 2.5};
    const Vector3d target = deviation(random, made.offset_m, made.turn_rad);
    const Vector3d other = deviation(random, made.offset_m, made.turn_rad);
    const bool goes_on = !made.look_alike || (made.bays && axis != 0);
    const Vector3d source = goes_on ? target : other;
    one.deviation = source - target + deviation(random, made.noise * kNoiseM, made.noise * kNoiseRad);
    one.measured = Vector3d(kNoiseM, kNoiseRad, kNoiseRad).cwiseAbs2().asDiagonal();
    one.measured *= made.noise * made.noise;
    if (!made.turns_are_known) one.measured(1, 1) = one.measured(2, 2) = 1.0;
    one.long_enough = true;
    const Vector3d mean = 0.5 * (source + target) + deviation(random, 0.0, made.noise * kNoiseRad);
    one.mean_normal = (one.normal - mean[1] * one.along[0] - mean[2] * one.along[1]).normalized();
    one.normal_sigma_rad = {made.noise * kNoiseRad, made.noise * kNoiseRad};
    surfaces.push_back(one);
  }
  return surfaces;
}

double as_built_nats(const std::vector<CommonSurface>& surfaces) {
  return built_nats(built_evidence(surfaces), {bends_beforehand(0.0)});
}

double least_of(const Made& made) {
  double least = 1e9;
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    least = std::min(least, as_built_nats(scanned(made, seed)));
  return least;
}

double most_of(const Made& made) {
  double most = -1e9;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) most = std::max(most, as_built_nats(scanned(made, seed)));
  return most;
}

double mean_of(const Made& made) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) sum += as_built_nats(scanned(made, seed));
  return sum / 10.0;
}

TEST(AsBuilt, ABuildingThatStandsAsDrawnSaysNothing) {
  const Made drawn{.surfaces = 20, .offset_m = 0.0, .turn_rad = 0.0, .look_alike = true};
  EXPECT_LT(most_of(drawn), 0.1);
  EXPECT_GT(least_of(drawn), -0.1);
}

TEST(AsBuilt, WallsSayWhetherABuildingIsAsDrawn) {
  const auto probability = [](const Made& made, std::uint64_t seed) {
    return probability_as_drawn(as_drawn_nats(built_evidence(scanned(made, seed))));
  };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_GT(probability({.offset_m = 0.0, .turn_rad = 0.0}, seed), 0.99);
    EXPECT_LT(probability({}, seed), 1e-6);
    // A look-alike place shows it as well.
    EXPECT_GT(probability({.offset_m = 0.0, .turn_rad = 0.0, .look_alike = true}, seed), 0.99);
    // Walls that differ may be a bent sensor's and say little.
    EXPECT_LT(probability({.look_alike = true}, seed), 0.1);
    // A noisy sensor does not.
    EXPECT_NEAR(probability({.offset_m = 0.0, .turn_rad = 0.0, .noise = 60.0}, seed),
                evidence_table::kAsDrawn, evidence_table::kAsDrawn);
  }
  EXPECT_NEAR(probability_as_drawn(0.0), evidence_table::kAsDrawn, 1e-12);
}

TEST(AsBuilt, OnePlaceIsStatedTheBetterTheMoreOfItIsSeen) {
  EXPECT_GT(least_of({.surfaces = 9}), 3.0);
  EXPECT_GT(mean_of({.surfaces = 14}), mean_of({.surfaces = 9}) + 5.0);
  EXPECT_GT(mean_of({.surfaces = 20}), mean_of({.surfaces = 14}) + 5.0);
  EXPECT_GT(least_of({.surfaces = 20}), 15.0);  // no bound at some odds
}

TEST(AsBuilt, ALookAlikeIsStatedAsOne) {
  // A sensor that bends by as much would explain most of it.
  EXPECT_LT(most_of({.look_alike = true}), 0.0);
}

TEST(AsBuilt, SurfacesThatGoOnFromBayToBaySayNothingOfTheBay) {
  EXPECT_LT(most_of({.look_alike = true, .bays = true}), 0.0);
}

TEST(AsBuilt, ANoisySensorTellsLess) {
  const double sharp = mean_of({});
  const double noisy = mean_of({.noise = 10.0});
  EXPECT_LT(noisy, 0.4 * sharp);
  EXPECT_LT(std::abs(mean_of({.noise = 60.0})), 0.5);
}

TEST(AsBuilt, WhatAMoveOfThePoseExplainsIsNoEvidence) {
  const Vector3d turn(0.001, -0.002, 0.0015);
  const Vector3d shift(0.004, 0.003, -0.002);
  for (const bool look_alike : {false, true}) {
    std::vector<CommonSurface> surfaces = scanned({.look_alike = look_alike}, 3);
    const double before = as_built_nats(surfaces);
    for (CommonSurface& one : surfaces) {
      one.deviation[0] += one.at.cross(one.normal).dot(turn) + one.normal.dot(shift);
      for (Eigen::Index k = 0; k < 2; ++k)
        one.deviation[k + 1] += one.along[static_cast<std::size_t>(k)].cross(one.normal).dot(turn);
    }
    EXPECT_NEAR(as_built_nats(surfaces), before, 0.05) << look_alike;
  }
}

TEST(AsBuilt, ThreeOffsetsAreThePosesOwn) {
  EXPECT_LT(std::abs(mean_of({.surfaces = 3, .turns_are_known = false})), 0.2);
  EXPECT_GT(mean_of({.surfaces = 18, .turns_are_known = false}), 3.0);
}

TEST(AsBuilt, ASurfaceThatWasMovedCostsLittle) {
  std::vector<CommonSurface> surfaces = scanned({.surfaces = 20}, 4);
  const double before = as_built_nats(surfaces);
  surfaces[7].deviation[0] += 0.04;
  EXPECT_GT(as_built_nats(surfaces), before - 6.0);
}

TEST(AsBuilt, WithoutAWallNothingIsKnown) {
  std::vector<CommonSurface> slabs;
  for (const CommonSurface& one : scanned({}, 5))
    if (std::abs(one.normal.z()) > 0.5) slabs.push_back(one);
  EXPECT_EQ(as_built_nats(slabs), 0.0);
  EXPECT_EQ(as_built_nats({}), 0.0);
}

}  // namespace
}  // namespace limen
