// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/rotation_from_directions.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

Vector3d random_direction(RandomStream& random) {
  return normal_vector(random).normalized();
}

Matrix3d random_rotation(RandomStream& random, double max_angle) {
  const Vector3d direction = random_direction(random);
  return rotation_exp(random.uniform(0.0, max_angle) * direction);
}

TEST(RotationFromMainDirections, UndoesAMoveOfLessThan45Degrees) {
  RandomStream random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix3d truth = random_rotation(random, radians(40.0));
    const double skew = random.uniform(-0.1, 0.1);
    const MainDirections source{Vector3d::UnitZ(), Vector3d::UnitX(),
                                Vector3d(std::sin(skew), std::cos(skew), 0.0)};
    const auto sign = [&] { return random.below(2) == 0 ? 1.0 : -1.0; };
    const MainDirections target{sign() * (truth * source.horizontal), sign() * (truth * source.vertical_2),
                                sign() * (truth * source.vertical_1)};
    const Matrix3d found = rotation_from_main_directions(source, target);
    EXPECT_NEAR((found.transpose() * found - Matrix3d::Identity()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(found.determinant(), 1.0, 1e-12);
    EXPECT_LT(rotation_angle(found.transpose() * truth), 1e-9);
  }
}

TEST(RotationFromMainDirections, IsOrthonormalForSkewedDirections) {
  // Walls that are not upright: q of equation 12 is shorter than 1.
  const MainDirections source{Vector3d::UnitZ(), Vector3d(1.0, 0.0, 0.3).normalized(), Vector3d::UnitY()};
  const MainDirections target{Vector3d::UnitZ(), Vector3d(1.0, 0.1, 0.0).normalized(), Vector3d::UnitY()};
  const Matrix3d found = rotation_from_main_directions(source, target);
  EXPECT_NEAR((found.transpose() * found - Matrix3d::Identity()).norm(), 0.0, 1e-12);
  MainDirections bad = source;
  bad.vertical_1 = bad.vertical_2 = Vector3d::UnitZ();
  EXPECT_THROW(rotation_from_main_directions(bad, target), Error);
}

TEST(RotationFromDirections, IsExactOnExactPairs) {
  RandomStream random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix3d truth = random_rotation(random, 3.14159);
    std::vector<DirectionPair> pairs;
    const Vector3d first = random_direction(random);
    for (const Vector3d& d : {first, first.unitOrthogonal().eval()})
      pairs.push_back({d, truth * d, random.uniform(0.5, 2.0)});
    const RotationFit fit = rotation_from_directions(pairs);
    EXPECT_LT(rotation_angle(fit.rotation.transpose() * truth), 1e-7);
    EXPECT_FALSE(fit.free_axis.has_value());
  }
}

TEST(RotationFromDirections, AveragesNoiseBetterThanAPair) {
  RandomStream random(3);
  double all = 0.0;
  double two = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix3d truth = random_rotation(random, 3.0);
    std::vector<DirectionPair> pairs;
    for (int i = 0; i < 20; ++i) {
      const Vector3d d = Vector3d::Unit(i % 3);
      const Vector3d noise = 0.01 * normal_vector(random);
      pairs.push_back({d, (truth * d + noise).normalized(), 1.0});
    }
    const RotationFit fit = rotation_from_directions(pairs);
    all += std::pow(rotation_angle(fit.rotation.transpose() * truth), 2);
    pairs.resize(2);
    two += std::pow(rotation_angle(rotation_from_directions(pairs).rotation.transpose() * truth), 2);
  }
  EXPECT_LT(all, 0.25 * two);
}

TEST(RotationFromDirections, NamesTheAxisThatParallelDirectionsLeaveFree) {
  const std::vector<DirectionPair> pairs{{Vector3d::UnitZ(), Vector3d::UnitX(), 1.0},
                                         {-Vector3d::UnitZ(), -Vector3d::UnitX(), 2.0}};
  const RotationFit fit = rotation_from_directions(pairs);
  ASSERT_TRUE(fit.free_axis.has_value());
  EXPECT_NEAR(std::abs(fit.free_axis->x()), 1.0, 1e-9);
  EXPECT_NEAR((fit.rotation * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(fit.rotation.determinant(), 1.0, 1e-9);
  EXPECT_THROW(rotation_from_directions({}), Error);
}

}  // namespace
}  // namespace limen
