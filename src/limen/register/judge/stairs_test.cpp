// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/stairs.h"

#include <vector>

#include <gtest/gtest.h>

namespace limen {
namespace {

SurfaceDetail upright_piece(const Vector3d& at, const Vector3d& normal) {
  SurfaceDetail piece;
  piece.mean = at;
  piece.normal = normal;
  piece.area_m2 = 0.01F;
  piece.sigma_m = 0.001F;
  return piece;
}

/// Risers of a flight that leads up along x, each of three pieces.
std::vector<SurfaceDetail> risers(int count, double run_m, double rise_m) {
  std::vector<SurfaceDetail> pieces;
  for (int k = 0; k < count; ++k)
    for (const double y : {0.0, 0.2, 0.4})
      pieces.push_back(upright_piece({1.0 + k * run_m, y, 0.1 + k * rise_m}, -Vector3d::UnitX()));
  return pieces;
}

TEST(Stairs, AFlightIsFoundWithItsRailingsAndUnseenSteps) {
  const std::vector<Flight> flights = find_flights(risers(5, 0.28, 0.17));
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_NEAR(flights[0].slope, 0.17 / 0.28, 0.02);
  EXPECT_NEAR(flights[0].length_m, 4 * 0.28, 0.05);
  EXPECT_TRUE(flights[0].contains({1.6, 0.3, 0.5}));
  EXPECT_TRUE(flights[0].contains({1.6, 0.9, 1.3}));   // a railing
  EXPECT_TRUE(flights[0].contains({3.2, 0.2, 1.4}));   // a step higher up
  EXPECT_FALSE(flights[0].contains({1.6, 0.3, 2.5}));  // far above
  EXPECT_FALSE(flights[0].contains({1.6, 3.0, 0.5}));  // beside
}

/// From below, or from behind where nothing closes the steps: the backs of the risers.
TEST(Stairs, AFlightIsFoundFromBelow) {
  std::vector<SurfaceDetail> backs = risers(5, 0.18, 0.17);
  for (SurfaceDetail& piece : backs) piece.normal = Vector3d::UnitX();
  const std::vector<Flight> flights = find_flights(backs);
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_GT(flights[0].up.x(), 0.99);
  EXPECT_NEAR(flights[0].slope, 0.17 / 0.18, 0.02);
  EXPECT_NEAR(flights[0].length_m, 4 * 0.18, 0.05);
  EXPECT_TRUE(flights[0].contains({1.4, 0.3, 0.4}));
  EXPECT_FALSE(flights[0].contains({1.6, 0.3, -1.0}));  // on the floor below
}

TEST(Stairs, FurnitureInRowsIsNone) {
  EXPECT_TRUE(find_flights(risers(6, 0.28, 0.0)).empty());   // a row of chairs
  EXPECT_TRUE(find_flights(risers(6, 0.01, 0.35)).empty());  // boards of a shelf
  EXPECT_TRUE(find_flights(risers(6, 0.9, 0.5)).empty());    // tiers
  EXPECT_TRUE(find_flights(risers(2, 0.28, 0.17)).empty());  // two alone are chance
  EXPECT_TRUE(find_flights({}).empty());
}

}  // namespace
}  // namespace limen
