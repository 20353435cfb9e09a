// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/planes_by_wall.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

PlanarPolygon face(const Vector3d& normal, const Vector3d& at) {
  PlanarPolygon polygon;
  polygon.plane = {normal, normal.dot(at)};
  return polygon;
}

TEST(PlanesByWall, TheTwoFacesOfAWallAreOneWall) {
  const std::vector<PlanarPolygon> planes{face(Vector3d::UnitY(), {1.0, 2.3, 0.0}),
                                          face(-Vector3d::UnitY(), {7.0, 2.0, 1.0}),
                                          face(Vector3d::UnitY(), {0.0, -2.3, 0.0})};
  PlanesByWall walls(planes);
  const std::size_t wall = walls.wall_of(0);
  EXPECT_EQ(walls.wall_of(1), wall);
  EXPECT_NE(walls.wall_of(2), wall) << "the other side of the room";
  EXPECT_EQ(walls.sign_of(0), 1.0);
  EXPECT_EQ(walls.sign_of(1), -1.0);
  EXPECT_EQ(walls.sign_of(2), 1.0);
  EXPECT_EQ(walls.normal(wall), Vector3d::UnitY());
}

TEST(PlanesByWall, WallsAcrossOneAnotherAndFacesOfARoomAreTwo) {
  const std::vector<PlanarPolygon> planes{face(Vector3d::UnitX(), {0.0, 0.0, 0.0}),
                                          face(Vector3d::UnitY(), {0.0, 0.0, 0.0}),
                                          face(-Vector3d::UnitX(), {4.0, 0.0, 0.0})};
  PlanesByWall walls(planes);
  const std::size_t wall = walls.wall_of(0);
  EXPECT_NE(walls.wall_of(1), wall);
  EXPECT_NE(walls.wall_of(2), wall);
}

}  // namespace
}  // namespace limen
