// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/translation_from_planes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// Source points whose images under `truth` lie on planes with the given normals.
std::vector<PlanePair> pairs_of(const Rigid3& truth, const std::vector<Vector3d>& normals,
                                RandomStream& random, double noise_m = 0.0) {
  std::vector<PlanePair> pairs;
  for (const Vector3d& normal : normals) {
    PlanePair pair;
    pair.source_point = uniform_vector(Vector3d(-5.0, -5.0, 0.0), Vector3d(5.0, 5.0, 3.0), random);
    pair.target.normal = normal.normalized() * (random.below(2) == 0 ? 1.0 : -1.0);
    pair.target.offset = pair.target.normal.dot(truth * pair.source_point) + noise_m * random.normal();
    pair.weight = random.uniform(0.5, 3.0);
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(TranslationFromPlanes, SolvesThreePlanesExactlyOnTheNationalGrid) {
  RandomStream random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Rigid3 truth{rotation_exp(normal_vector(random)), Vector3d(1.05e6, 6.84e6, 150.0)};
    const auto pairs = pairs_of(truth, {{1.0, 0.1, 0.0}, {-0.3, 1.0, 0.05}, {0.0, 0.1, 1.0}}, random);
    const TranslationFit fit = translation_from_planes(truth.rotation, pairs);
    EXPECT_LT((fit.translation - truth.translation).norm(), 1e-6);
    EXPECT_LT(fit.rms_m, 1e-7);
    EXPECT_TRUE(fit.unobserved.empty());
    EXPECT_LT(fit.condition, 3.0);
  }
}

TEST(TranslationFromPlanes, IsTheLeastSquaresSolutionOfManyPlanes) {
  RandomStream random(2);
  const Rigid3 truth{rotation_exp(Vector3d(0.1, 0.2, 2.0)), Vector3d(3.0, -2.0, 1.0)};
  std::vector<Vector3d> normals;
  for (int i = 0; i < 12; ++i) normals.emplace_back(random.normal(), random.normal(), random.normal());
  const auto pairs = pairs_of(truth, normals, random, 0.02);
  const TranslationFit fit = translation_from_planes(truth.rotation, pairs);
  const auto cost = [&](const Vector3d& t) {
    double sum = 0.0;
    for (const PlanePair& p : pairs) {
      sum += p.weight * std::pow(p.target.signed_distance(truth.rotation * p.source_point + t), 2);
    }
    return sum;
  };
  EXPECT_LT((fit.translation - truth.translation).norm(), 0.05);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-4, 1e-4}) {
      EXPECT_LT(cost(fit.translation), cost(fit.translation + step * Vector3d::Unit(axis)));
    }
  }
}

TEST(TranslationFromPlanes, NamesDirectionsThatAreNotHeldAndKeepsTheStartThere) {
  RandomStream random(3);
  const Rigid3 truth{Matrix3d::Identity(), Vector3d(1.0, 2.0, 3.0)};
  const auto corridor = pairs_of(truth, {{0, 1, 0}, {0, 1, 0.01}, {0, 0, 1}}, random);
  const TranslationFit fit = translation_from_planes(truth.rotation, corridor, Vector3d(7.0, 0.0, 0.0));
  ASSERT_EQ(fit.unobserved.size(), 1U);
  EXPECT_NEAR(std::abs(fit.unobserved[0].x()), 1.0, 1e-9);
  EXPECT_NEAR(fit.translation.x(), 7.0, 1e-9);
  EXPECT_NEAR(fit.translation.y(), 2.0, 0.1);
  EXPECT_NEAR(fit.translation.z(), 3.0, 0.1);
  EXPECT_GT(fit.condition, 1e6);
  const TranslationFit nothing = translation_from_planes(truth.rotation, {}, Vector3d(1.0, 1.0, 1.0));
  EXPECT_EQ(nothing.unobserved.size(), 3U);
  EXPECT_EQ(nothing.translation, Vector3d(1.0, 1.0, 1.0));
}

TEST(TranslationFromPlanes, ConditionTellsWeakGeometry) {
  RandomStream random(4);
  const Rigid3 truth;
  const double tilt = radians(12.0);
  const auto weak = pairs_of(truth, {{0, 0, 1}, {0, 1, 0}, {std::sin(tilt), std::cos(tilt), 0}}, random);
  const TranslationFit fit = translation_from_planes(truth.rotation, weak);
  EXPECT_TRUE(fit.unobserved.empty());
  EXPECT_GT(fit.condition, 5.0);
}

}  // namespace
}  // namespace limen
