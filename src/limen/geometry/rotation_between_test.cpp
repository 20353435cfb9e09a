// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/rotation_between.h"

#include "support/laws.h"

namespace limen {
namespace {

using namespace testing_laws;

RC_GTEST_PROP(RotationBetweenLaws, TakesOneDirectionToTheOtherTheShortestWay, ()) {
  const Vector3d from = vector(5.0) + Vector3d(0.0, 0.0, 6.0);
  const Vector3d to = motion().rotation * from;
  const Matrix3d turn = rotation_between(from, 3.0 * to);
  RC_ASSERT((turn * from - to).norm() < 1e-11 * from.norm());
  RC_ASSERT((turn * turn.transpose() - Matrix3d::Identity()).norm() < 1e-12);
  const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
  RC_ASSERT(std::abs(rotation_angle(turn) - angle) < 1e-7);
}

TEST(RotationBetween, OppositeDirectionsAreAHalfTurnApart) {
  for (const Vector3d& from : {Vector3d(0.0, 0.0, 1.0), Vector3d(1.0, 0.0, 0.0), Vector3d(0.3, -2.0, 0.7)}) {
    const Matrix3d turn = rotation_between(from, -from);
    EXPECT_LT((turn * from + from).norm(), 1e-12);
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace limen
