// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/triangulate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

double area_of(const Triangle2& t) {
  return 0.5 * ((t[1] - t[0]).x() * (t[2] - t[0]).y() - (t[1] - t[0]).y() * (t[2] - t[0]).x());
}

bool is_corner(const Polygon& polygon, const Vector2d& p) {
  const auto in = [&](const Ring& ring) { return std::find(ring.begin(), ring.end(), p) != ring.end(); };
  return in(polygon.outer) || std::any_of(polygon.holes.begin(), polygon.holes.end(), in);
}

/// Positive triangles of the polygon's own corners whose areas add up to its area and that stay inside it
/// can only be a partition.
void expect_partition(const Polygon& polygon) {
  double sum = 0.0;
  for (const Triangle2& triangle : triangulate(polygon)) {
    ASSERT_GT(area_of(triangle), 0.0);
    sum += area_of(triangle);
    for (const Vector2d& corner : triangle) ASSERT_TRUE(is_corner(polygon, corner));
    if (area_of(triangle) < 1e-6) continue;
    const Vector2d middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    ASSERT_TRUE(contains(polygon, middle));
    // Close to each side, from within.
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(
          contains(polygon, 0.999 * (0.3 * triangle[i] + 0.7 * triangle[(i + 1) % 3]) + 0.001 * middle));
  }
  EXPECT_NEAR(sum, area(polygon), 1e-9);
}

Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

Ring star(RandomStream& random, const Vector2d& centre, double radius) {
  Ring ring;
  const int corners = 3 + static_cast<int>(random.below(14));
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random.uniform(0.0, 0.8)) / corners;
    ring.push_back(centre + radius * random.uniform(0.2, 1.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

TEST(Triangulate, RectangleGivesTwoTriangles) {
  EXPECT_EQ(triangulate({rectangle(0, 0, 4, 3), {}}).size(), 2U);
}

TEST(Triangulate, WallWithWindowsIsCoveredOnce) {
  Polygon wall{rectangle(0, 0, 12, 3), {}};
  for (const double x : {1.0, 4.0, 7.0, 10.0}) wall.holes.push_back(rectangle(x, 1, x + 1.2, 2.4));
  expect_partition(wall);
  // Corners in one line are passed over: never more than corners + 2 holes - 2.
  EXPECT_LE(triangulate(wall).size(), 20U + 8U - 2U);
}

TEST(Triangulate, RingsMayRunEitherWay) {
  Polygon wall{rectangle(0, 0, 5, 3), {rectangle(1, 1, 2, 2)}};
  std::reverse(wall.outer.begin(), wall.outer.end());
  double sum = 0.0;
  for (const Triangle2& triangle : triangulate(wall)) sum += area_of(triangle);
  EXPECT_NEAR(sum, 14.0, 1e-12);
}

TEST(Triangulate, RepeatedAndCollinearCornersAndSpikesAreNothing) {
  const Polygon odd{{{0, 0}, {1, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 1}, {6, 1}, {4, 1}, {4, 3}, {0, 3}, {0, 0}},
                    {}};
  double sum = 0.0;
  for (const Triangle2& triangle : triangulate(odd)) sum += area_of(triangle);
  EXPECT_NEAR(sum, 12.0, 1e-12);
}

TEST(Triangulate, HolesMayTouchTheOutlineAndOneAnother) {
  // A diamond whose tips touch the outline, another that touches the first.
  expect_partition({rectangle(0, 0, 8, 2), {{{0, 1}, {1, 2}, {2, 1}, {1, 0}}}});
  expect_partition(
      {rectangle(0, 0, 8, 4), {{{1, 2}, {2, 3}, {3, 2}, {2, 1}}, {{3, 2}, {4, 3}, {5, 2}, {4, 1}}}});
  expect_partition({rectangle(0, 0, 8, 4), {{{0, 0}, {1, 2}, {2, 1}}, {{8, 4}, {7, 2}, {6, 3}}}});
  expect_partition({rectangle(0, 0, 9, 9), {rectangle(1, 1, 4, 4), rectangle(4, 4, 8, 8)}});
}

TEST(Triangulate, OutlineMayTouchItself) {
  // Two squares joined in one corner, as a ring that passes the corner twice.
  expect_partition({{{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}, {}});
}

TEST(Triangulate, WhatHasNoAreaGivesNothing) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{{0, 0}, {1, 1}}, {}}).empty());
  EXPECT_TRUE(triangulate({{{0, 0}, {1, 1}, {2, 2}}, {}}).empty());
}

TEST(Triangulate, RandomStarsWithHolesAreCoveredOnce) {
  RandomStream random(7);
  int pierced = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    std::vector<Polygon> holes;
    const int count = static_cast<int>(random.below(9));
    for (int i = 0; i < count; ++i) {
      const Vector2d at = uniform_vector(Vector2d(-4.0, -4.0), Vector2d(4.0, 4.0), random);
      holes.push_back({star(random, at, random.uniform(0.2, 2.0)), {}});
    }
    const Polygon whole{star(random, Vector2d::Zero(), 6.0), {}};
    for (const Polygon& part : difference({whole}, holes)) {
      pierced += part.holes.empty() ? 0 : 1;
      expect_partition(part);
      if (HasFatalFailure() || HasNonfatalFailure()) FAIL() << "trial " << trial;
    }
  }
  EXPECT_GT(pierced, 200);
}

TEST(Triangulate, AlignedRectanglesThatTouchAreCoveredOnce) {
  // Whole coordinates: corners meet edges and corners all the time.
  RandomStream random(8);
  for (int trial = 0; trial < 1500; ++trial) {
    std::vector<Polygon> holes;
    for (int i = 0; i < 6; ++i) {
      const double x = random.below(10);
      const double y = random.below(10);
      holes.push_back({rectangle(x, y, x + 1.0 + random.below(4), y + 1.0 + random.below(3)), {}});
    }
    for (const Polygon& part : difference({{rectangle(0, 0, 12, 12), {}}}, holes)) {
      expect_partition(part);
      if (HasFatalFailure() || HasNonfatalFailure()) FAIL() << "trial " << trial;
    }
  }
}

}  // namespace
}  // namespace limen
