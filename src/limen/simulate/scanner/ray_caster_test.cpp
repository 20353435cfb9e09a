// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/ray_caster.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

Vector3d somewhere(RandomStream& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

/// Distance along the ray to a triangle, by solving for the three weights; infinity where it is missed.
double distance_to(const Mesh& mesh, std::size_t triangle, const Vector3d& origin,
                   const Vector3d& direction) {
  const auto& corners = mesh.triangles()[triangle];
  const Vector3d& a = mesh.vertices()[corners[0]];
  Matrix3d system;
  system << mesh.vertices()[corners[1]] - a, mesh.vertices()[corners[2]] - a, -direction;
  const Vector3d weights = system.inverse() * (origin - a);
  const bool inside =
      weights[0] >= 0.0 && weights[1] >= 0.0 && weights[0] + weights[1] <= 1.0 && weights[2] > 0.0;
  return inside ? weights[2] : std::numeric_limits<double>::infinity();
}

TEST(RayCaster, FindsTheNearestTriangleOfManyAsASearchOverAllDoes) {
  RandomStream random(3);
  Mesh mesh;
  for (int i = 0; i < 300; ++i) {
    const Vector3d p = somewhere(random, 5.0);
    mesh.add_sheet({p, p + somewhere(random, 1.0), p + somewhere(random, 1.0)},
                   surface_of(Element::furniture));
  }
  const RayCaster caster(mesh);
  int hits = 0;
  for (int ray = 0; ray < 500; ++ray) {
    const Vector3d origin = somewhere(random, 6.0);
    const Vector3d direction = somewhere(random, 1.0).normalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i)
      nearest = std::min(nearest, distance_to(mesh, i, origin, direction));
    const RayHit hit = caster.cast(origin, direction);
    EXPECT_EQ(hit.found(), std::isfinite(nearest));
    if (!hit.found()) continue;
    ++hits;
    EXPECT_NEAR(hit.range_m, nearest, 1e-9);
    const Plane& plane = mesh.surfaces()[static_cast<std::size_t>(hit.surface)].plane;
    EXPECT_LT(plane.normal.dot(direction), 0.0) << "a sheet is met on the side that faces the ray";
  }
  EXPECT_GT(hits, 50);
}

TEST(RayCaster, KnowsABoxFromItsInside) {
  Mesh mesh;
  mesh.add_box({{0.0, 0.0, -1.0}, 0.3}, {2.0, 2.0, 2.0}, surface_of(Element::furniture));
  const RayCaster caster(mesh);
  EXPECT_TRUE(caster.cast({0.1, 0.2, 0.0}, Vector3d::UnitX()).inside);
  const RayHit above = caster.cast({0.1, 0.2, 4.0}, -Vector3d::UnitZ());
  EXPECT_FALSE(above.inside);
  EXPECT_DOUBLE_EQ(above.range_m, 3.0);
  EXPECT_FALSE(caster.cast({0.1, 0.2, 4.0}, Vector3d::UnitZ()).found());
}

}  // namespace
}  // namespace limen
