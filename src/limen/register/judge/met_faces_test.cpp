// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/met_faces.h"

#include <numeric>

#include <gtest/gtest.h>

namespace limen {
namespace {

MetFace facing(const Vector3d& normal, const Vector3d& at, double offset_m = 0.0) {
  MetFace face;
  face.at = at;
  face.normal = normal;
  face.offset_m = offset_m;
  face.sigma_m = 0.002;
  return face;
}

double observations(const std::vector<MetFace>& faces) {
  const std::vector<double> shares = shares_of(faces, 3.2);
  return std::accumulate(shares.begin(), shares.end(), 0.0);
}

TEST(MetFaces, TwoSidesOfOneThingTellTwoThings) {
  // How far a box was pushed one way says nothing of the other way; that its back moved with its front does.
  const MetFace front = facing(Vector3d::UnitX(), {0.2, 0, 0.5});
  const MetFace side = facing(Vector3d::UnitY(), {0, 0.2, 0.5});
  const MetFace back = facing(-Vector3d::UnitX(), {-0.2, 0, 0.5});
  EXPECT_NEAR(observations({front, side}), 2.0, 1e-9);
  EXPECT_LT(observations({front, back}), 1.5);
  EXPECT_NEAR(observations({front, facing(Vector3d::UnitX(), {3.0, 0, 0.5})}), 2.0, 1e-2);
}

TEST(MetFaces, PiecesOfOneFaceAreJoined) {
  std::vector<MetFace> pieces;
  for (int k = 0; k < 9; ++k)
    pieces.push_back(facing(Vector3d::UnitX(), {1.0, 0.1 * k, 0.5}, 0.001 * (k % 3)));
  pieces.push_back(facing(Vector3d::UnitY(), {1.0, 0.9, 0.5}, 0.02));
  const std::vector<MetFace> faces = joined(pieces);
  ASSERT_EQ(faces.size(), 2U);
  EXPECT_NEAR(faces.front().offset_m, 0.001, 1e-9);
  EXPECT_DOUBLE_EQ(faces.front().weight, 9.0);
  EXPECT_LT(faces.front().sigma_m, 0.001);
  EXPECT_NEAR(faces.back().offset_m, 0.02, 1e-12);
}

}  // namespace
}  // namespace limen
