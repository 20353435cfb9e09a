// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

struct Ceilings {
  Scan scan;
  PlaneLabels planes;
};

/// Two ceilings `step_m` apart in height, a metre between them, labelled as one plane; far from the origin.
Ceilings two_ceilings(double step_m) {
  Ceilings made;
  RandomStream stream(3);
  for (int i = 0; i < 900; ++i) {
    const bool second = i % 3 == 0;
    const double x = (second ? 4.0 : 0.0) + stream.uniform(0.0, 3.0);
    made.scan.points.emplace_back(500.0 + x, 300.0 + stream.uniform(0.0, 2.0), (second ? step_m : 0.0) + 3.0);
  }
  made.planes.fits.resize(1);
  made.planes.fits[0].plane = {Vector3d::UnitZ(), 3.0};
  made.planes.fits[0].centroid = {503.0, 301.0, 3.0};
  made.planes.labels.assign(made.scan.size(), 0);
  return made;
}

TEST(SplitPlanes, EachPieceIsItsOwnPlane) {
  const Ceilings made = two_ceilings(0.012);
  const PlaneLabels split = split_planes(made.scan, made.planes);
  ASSERT_EQ(split.fits.size(), 2U);
  EXPECT_NEAR(std::abs(split.fits[0].plane.offset), 3.0, 1e-6);
  EXPECT_NEAR(std::abs(split.fits[1].plane.offset), 3.012, 1e-6);
  for (std::size_t i = 0; i < made.scan.size(); ++i) EXPECT_EQ(split.labels[i], i % 3 == 0 ? 1 : 0);
}

TEST(SplitPlanes, SmallPiecesAreDropped) {
  Ceilings made = two_ceilings(0.012);
  for (std::size_t i = 60; i < made.scan.size(); i += 3) made.planes.labels[i] = -1;  // 20 points are left
  const PlaneLabels split = split_planes(made.scan, made.planes);
  ASSERT_EQ(split.fits.size(), 1U);
  EXPECT_EQ(split.labels[0], -1);
}

}  // namespace
}  // namespace limen
