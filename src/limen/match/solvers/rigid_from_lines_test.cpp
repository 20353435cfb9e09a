// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/rigid_from_lines.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"

namespace limen {
namespace {

Vector3d any_vector(RandomStream& random) {
  return {random.normal(), random.normal(), random.normal()};
}

/// A line of the source, and its image with the point slid along it.
LinePair pair_under(const Rigid3& truth, const Vector3d& point, const Vector3d& direction, double slide) {
  LinePair pair;
  pair.source = {point, direction.normalized()};
  pair.target = {truth * (point + slide * direction), truth.rotation * direction.normalized()};
  return pair;
}

TEST(RigidFromLines, TwoPairsGiveThePoseExactly) {
  RandomStream random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Rigid3 truth{rotation_exp(any_vector(random)), 100.0 * any_vector(random)};
    const auto vertical = pair_under(truth, any_vector(random), Vector3d::UnitZ(), random.normal());
    const auto horizontal = pair_under(truth, any_vector(random), Vector3d(1.0, 0.4, 0.05), random.normal());
    const Rigid3 pose = rigid_from_lines(vertical, horizontal);
    EXPECT_LT((pose.rotation - truth.rotation).norm(), 1e-12);
    EXPECT_LT((pose.translation - truth.translation).norm(), 1e-10);
    EXPECT_NEAR(pose.rotation.determinant(), 1.0, 1e-12);
  }
}

TEST(RigidFromLines, TheRotationIsExactOnTheVertical) {
  LinePair vertical;
  vertical.source.direction = Vector3d::UnitZ();
  vertical.target.direction = Vector3d::UnitX();
  LinePair horizontal;
  horizontal.source.direction = Vector3d::UnitX();
  horizontal.target.direction = Vector3d(0.1, 1.0, 0.0).normalized();  // not at right angles to its vertical
  const Matrix3d rotation = rotation_from_lines(vertical, horizontal);
  EXPECT_LT((rotation * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((rotation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-12);
}

TEST(RigidFromLines, LeastSquaresOfManyLines) {
  RandomStream random(2);
  const Rigid3 truth{rotation_exp(Vector3d(0.1, 0.2, 2.0)), Vector3d(3.0, -2.0, 1.0)};
  std::vector<LinePair> pairs;
  for (int i = 0; i < 12; ++i) {
    pairs.push_back(pair_under(truth, 3.0 * any_vector(random), any_vector(random), random.normal()));
    pairs.back().target.point += 0.02 * any_vector(random);
    pairs.back().weight = random.uniform(0.5, 2.0);
  }
  const TranslationFit fit = translation_from_lines(truth.rotation, pairs);
  const auto cost = [&](const Vector3d& t) {
    double sum = 0.0;
    for (const LinePair& p : pairs) {
      const Vector3d apart = p.target.point - (truth.rotation * p.source.point + t);
      sum += p.weight * p.target.direction.cross(apart).squaredNorm();  // (17), (18)
    }
    return sum;
  };
  EXPECT_LT((fit.translation - truth.translation).norm(), 0.05);
  EXPECT_TRUE(fit.unobserved.empty());
  for (int i = 0; i < 20; ++i) {
    EXPECT_GT(cost(fit.translation + 0.01 * any_vector(random)), cost(fit.translation));
  }
}

TEST(RigidFromLines, ParallelLinesLeaveTheirDirectionOpen) {
  const Rigid3 truth{Matrix3d::Identity(), Vector3d(1.0, 2.0, 3.0)};
  const std::vector<LinePair> pairs = {pair_under(truth, Vector3d(0.0, 0.0, 0.0), Vector3d::UnitZ(), 0.5),
                                       pair_under(truth, Vector3d(4.0, 0.0, 0.0), Vector3d::UnitZ(), -0.5)};
  const TranslationFit fit = translation_from_lines(truth.rotation, pairs, Vector3d(0.0, 0.0, 7.0));
  ASSERT_EQ(fit.unobserved.size(), 1U);
  EXPECT_NEAR(std::abs(fit.unobserved[0].z()), 1.0, 1e-9);
  EXPECT_LT((fit.translation - Vector3d(1.0, 2.0, 7.0)).norm(), 1e-9);
  EXPECT_TRUE(std::isinf(fit.condition));
  EXPECT_THROW((void)rigid_from_lines(pairs[0], pairs[1]), Error);
}

TEST(RigidFromLines, AWallsNormalLeftOutIsNotPulledToZero) {
  // The outer edges of a window lie 0.4 m before the inner ones.
  const Rigid3 truth{Matrix3d::Identity(), Vector3d(1.0, 2.0, 3.0)};
  std::vector<LinePair> pairs = {pair_under(truth, Vector3d(0.0, 0.0, 0.0), Vector3d::UnitZ(), 0.5),
                                 pair_under(truth, Vector3d(1.0, 0.0, 0.0), Vector3d::UnitX(), -0.5)};
  for (LinePair& pair : pairs) {
    pair.target.point.y() -= 0.4;
    pair.wall_normal = Vector3d::UnitY();
  }
  const TranslationFit fit = translation_from_lines(truth.rotation, pairs, Vector3d(0.0, 2.0, 0.0));
  ASSERT_EQ(fit.unobserved.size(), 1U);
  EXPECT_NEAR(std::abs(fit.unobserved[0].y()), 1.0, 1e-9);
  EXPECT_LT((fit.translation - truth.translation).norm(), 1e-9);
  EXPECT_NEAR(fit.rms_m, 0.0, 1e-9);
  for (LinePair& pair : pairs) pair.wall_normal.reset();
  EXPECT_NEAR(translation_from_lines(truth.rotation, pairs).translation.y(), 1.6, 1e-9);
}

TEST(RigidFromLines, NoPairsHoldNothing) {
  const TranslationFit fit = translation_from_lines(Matrix3d::Identity(), {}, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(fit.unobserved.size(), 3U);
  EXPECT_EQ(fit.translation, Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace limen
