// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/uneven_walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

/// Planes along a square (walls; every fifth one level), each askew by normal deviations of `askew_deg`, the
/// same in both scans or, of a twin, others in each; measured to 0.02 degrees.
std::vector<CommonPlane> planes_of(std::size_t count, double askew_deg, bool twin, std::uint32_t seed,
                                   double turned_rad = 0.0) {
  constexpr double kMeasuredDeg = 0.02;
  const double sigma = radians(kMeasuredDeg);
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const auto small_turn = [&](double size_rad) {
    return Vector3d(size_rad * normal(engine), size_rad * normal(engine), size_rad * normal(engine));
  };
  std::vector<CommonPlane> planes;
  for (std::size_t k = 0; k < count; ++k) {
    const double heading = 0.5 * std::numbers::pi * static_cast<double>(k % 4) + turned_rad;
    const Vector3d drawn =
        k % 5 == 4 ? Vector3d(Vector3d::UnitZ()) : Vector3d(std::cos(heading), std::sin(heading), 0.0);
    const Vector3d first = small_turn(radians(askew_deg));
    const Vector3d second = twin ? small_turn(radians(askew_deg)) : first;
    CommonPlane plane;
    plane.source_normal = (drawn + (first + small_turn(sigma)).cross(drawn)).normalized();
    plane.target_normal = (drawn + (second + small_turn(sigma)).cross(drawn)).normalized();
    plane.length_m = {3.0, 2.5};
    plane.source_sigma_rad = plane.target_sigma_rad = {sigma, sigma};
    planes.push_back(plane);
  }
  return planes;
}

double median_of(std::size_t count, double askew_deg, bool twin) {
  std::vector<double> nats;
  for (std::uint32_t seed = 1; seed <= 41; ++seed)
    nats.push_back(unevenness_nats(planes_of(count, askew_deg, twin, seed)));
  std::nth_element(nats.begin(), nats.begin() + 20, nats.end());
  return nats[20];
}

TEST(UnevenWalls, WallsAskewAlikeSpeakAgainstATwin) {
  EXPECT_GT(median_of(6, 0.3, false), std::log(10.0));
  EXPECT_GT(median_of(4, 0.3, false), 1.0);
  EXPECT_LE(unevenness_nats(planes_of(12, 0.6, false, 3)), std::log(20.0) + 1e-9);
}

TEST(UnevenWalls, WallsThatStandAsDrawnSayNothing) {
  EXPECT_LT(median_of(6, 0.0, false), 0.4);
  EXPECT_LT(median_of(12, 0.0, true), 0.4);
}

TEST(UnevenWalls, TwinsAskewInTheirOwnWayAreNotTakenForOne) {
  int taken = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed)
    taken += unevenness_nats(planes_of(6, 0.3, true, seed)) > 0.5 ? 1 : 0;
  EXPECT_LE(taken, 20);
}

TEST(UnevenWalls, TwoPlanesAreFittedByATurn) {
  EXPECT_EQ(unevenness_nats(planes_of(2, 0.5, false, 7)), 0.0);
  EXPECT_EQ(unevenness_nats({}), 0.0);
}

TEST(UnevenWalls, TheSquareMayBeTurned) {
  const double as_it_is = unevenness_nats(planes_of(6, 0.3, false, 5));
  EXPECT_NEAR(unevenness_nats(planes_of(6, 0.3, false, 5, 0.5 * std::numbers::pi)), as_it_is, 0.5);
  EXPECT_GT(unevenness_nats(planes_of(6, 0.3, false, 5, -0.78)), 2.0);
}

}  // namespace
}  // namespace limen
