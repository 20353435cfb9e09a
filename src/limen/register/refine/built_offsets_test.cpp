// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/built_offsets.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace limen {
namespace {

/// A face of 4 m x 3 m that the scan sees `off_m` from where the model has it.
PlaneSums face(const Vector3d& middle, const Vector3d& normal, double off_m) {
  constexpr double kWeight = 1.0 / (0.001 * 0.001);
  const Vector3d across = normal.unitOrthogonal();
  const Vector3d up = normal.cross(across);
  PlaneSums sums;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const Vector3d from_middle = 0.5 * i * across + 0.5 * j * up;
      Vector6d row;
      row << (middle + from_middle).cross(normal), normal;
      const Vector3d whole(1.0, 0.5 * i, 0.5 * j);
      sums.add(row, off_m, whole, kWeight);
      sums.weight += kWeight;
    }
  }
  return sums;
}

/// Faces that meet the x axis at 0, 5 and 9 m, each off by as much, and faces across y and z that are not.
std::vector<PlaneSums> building(const std::vector<double>& off_m) {
  std::vector<PlaneSums> planes;
  const double at[] = {0.0, 5.0, 9.0};
  for (std::size_t k = 0; k < off_m.size(); ++k)
    planes.push_back(face({at[k], 0.0, 0.0}, Vector3d::UnitX(), off_m[k]));
  for (const double end : {-3.0, 3.0}) {
    planes.push_back(face({2.0, end, 0.0}, Vector3d::UnitY(), 0.0));
    planes.push_back(face({2.0, 0.0, end}, Vector3d::UnitZ(), 0.0));
  }
  return planes;
}

SettledPose settled(const std::vector<double>& off_m) {
  return settle_among_moved(building(off_m), 1e-4, 1.0);
}

double sigma_x(const SettledPose& pose) {
  return std::sqrt(inverse_of(pose.information)(3, 3));
}

TEST(SettleAmongMoved, WallsThatAreWhereTheModelHasThemHoldThePoseAsBuildersErr) {
  const SettledPose pose = settled({0.0, 0.0, 0.0});
  EXPECT_LT(pose.step.norm(), 1e-6);
  EXPECT_GT(sigma_x(pose), 0.0008);
  EXPECT_LT(sigma_x(pose), 0.004);
  for (const double moved : pose.moved) EXPECT_LT(moved, 0.1);
}

TEST(SettleAmongMoved, OneOfThreeWallsThatWasMovedDoesNotPullThePose) {
  for (const double off_m : {0.015, 0.03, -0.05}) {
    const SettledPose pose = settled({0.0, off_m, 0.0});
    EXPECT_LT(std::abs(pose.step[3]), 0.001) << off_m;
    EXPECT_GT(pose.moved[1], 0.9) << off_m;
    EXPECT_LT(pose.moved[0], 0.1) << off_m;
    EXPECT_LT(sigma_x(pose), 0.01) << off_m;
  }
}

TEST(SettleAmongMoved, APoseThatFollowedTheMovedWallIsBroughtBack) {
  const SettledPose pose = settled({0.03, 0.0, 0.03});
  EXPECT_NEAR(pose.step[3], 0.03, 0.001);
  EXPECT_GT(pose.moved[1], 0.9);
}

TEST(SettleAmongMoved, OfTwoWallsNobodyKnowsWhichOneWasMoved) {
  const SettledPose pose = settled({0.0, 0.03});
  EXPECT_GT(sigma_x(pose), 0.01);
  EXPECT_LT(sigma_x(pose), 0.04);
  EXPECT_LT(std::sqrt(inverse_of(pose.information)(4, 4)), 0.005) << "y is known as before";
}

/// Openings of one wall, measured to 4 mm, that are off along x.
PlaneSums openings(double off_m) {
  constexpr double kWeight = 1.0 / (0.004 * 0.004);
  PlaneSums sums;
  sums.weight = kWeight;
  sums.add(Vector6d::Unit(3), off_m, Vector3d::UnitX(), kWeight);
  return sums;
}

TEST(SettleAmongMoved, OpeningsOfAWallDecideBetweenTwoOthers) {
  std::vector<PlaneSums> planes = building({0.0, 0.03});
  planes.push_back(openings(0.03));
  const SettledPose pose = settle_among_moved(planes, 1e-4, 1.0);
  EXPECT_NEAR(pose.step[3], 0.03, 0.002);
  EXPECT_GT(pose.moved[0], 0.9);
  EXPECT_GT(sigma_x(pose), 0.003) << "that wall may have been moved, too";
}

}  // namespace
}  // namespace limen
