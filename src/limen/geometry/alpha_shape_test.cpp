// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/alpha_shape.h"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/thinning.h"

namespace limen {
namespace {

using Key = std::pair<long, long>;
using Edge = std::pair<Key, Key>;

constexpr double kLattice_m = 0.01;

Key key_of(const Vector2d& p) {
  return {std::lround(p.x() / kLattice_m), std::lround(p.y() / kLattice_m)};
}

Edge edge_of(const Vector2d& p, const Vector2d& q) {
  return std::minmax(key_of(p), key_of(q));
}

void add_edges(const Ring& ring, std::multiset<Edge>& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i) edges.insert(edge_of(ring[i], ring[(i + 1) % ring.size()]));
}

std::multiset<Edge> edges_of(const std::vector<Polygon>& polygons) {
  std::multiset<Edge> edges;
  for (const Polygon& polygon : polygons) {
    add_edges(polygon.outer, edges);
    for (const Ring& hole : polygon.holes) add_edges(hole, edges);
  }
  return edges;
}

bool empty_disc(const std::vector<Vector2d>& points, const Vector2d& centre, double radius, std::size_t i,
                std::size_t j) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k != i && k != j && (points[k] - centre).norm() < radius) return false;
  }
  return true;
}

/// By definition: a pair of points is an edge of the outline when exactly one of the two discs of radius
/// alpha through both is empty (two empty ones: a dangling edge).
std::multiset<Edge> outline_by_definition(const std::vector<Vector2d>& points, double alpha) {
  std::multiset<Edge> edges;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Vector2d half = 0.5 * (points[j] - points[i]);
      if (half.norm() >= alpha) continue;
      const Vector2d across = Vector2d(-half.y(), half.x()).normalized();
      const Vector2d rise = across * std::sqrt(alpha * alpha - half.squaredNorm());
      const Vector2d middle = points[i] + half;
      if (empty_disc(points, middle + rise, alpha, i, j) != empty_disc(points, middle - rise, alpha, i, j)) {
        edges.insert(edge_of(points[i], points[j]));
      }
    }
  }
  return edges;
}

std::vector<Vector2d> random_lattice_points(RandomStream& random, std::uint32_t count, std::uint32_t width) {
  std::set<Key> keys;
  for (std::uint32_t i = 0; i < count; ++i) {
    keys.emplace(static_cast<long>(random.below(width)), static_cast<long>(random.below(width)));
  }
  std::vector<Vector2d> points;
  for (const Key& key : keys) {
    points.push_back(kLattice_m * Vector2d(static_cast<double>(key.first), static_cast<double>(key.second)));
  }
  return points;
}

void expect_simple_rings(const Polygon& polygon) {
  EXPECT_GT(signed_area(polygon.outer), 0.0);
  for (const Ring& hole : polygon.holes) EXPECT_LT(signed_area(hole), 0.0);
  const auto distinct = [](const Ring& ring) {
    std::set<Key> keys;
    for (const Vector2d& p : ring) keys.insert(key_of(p));
    return keys.size();
  };
  EXPECT_EQ(distinct(polygon.outer), polygon.outer.size());
  for (const Ring& hole : polygon.holes) EXPECT_EQ(distinct(hole), hole.size());
}

bool in_rectangle(const Vector2d& p, double x0, double y0, double x1, double y1) {
  return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1;
}

/// Points all over [0, 6] x [0, 4] but the window [2, 3] x [1, 2.5].
std::vector<Vector2d> wall_with_window(std::uint64_t seed, int count) {
  RandomStream random(seed);
  std::vector<Vector2d> points;
  while (static_cast<int>(points.size()) < count) {
    const Vector2d p = uniform_vector(Vector2d(0.0, 0.0), Vector2d(6.0, 4.0), random);
    if (!in_rectangle(p, 2.0, 1.0, 3.0, 2.5)) points.push_back(p);
  }
  return points;
}

AlphaShapeOptions options(double alpha_m, bool thin) {
  AlphaShapeOptions made;
  made.alpha_m = alpha_m;
  made.thin = thin;
  return made;
}

TEST(AlphaShape, IsTheOutlineOfItsDefinitionOnRandomSets) {
  int edges = 0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    RandomStream random(1, trial);
    const auto points = random_lattice_points(random, 5 + random.below(70), 8 + random.below(90));
    const double alpha = kLattice_m * (random.uniform(0.6, 14.0) + 1e-4);
    const auto shape = alpha_shape(points, options(alpha, false));
    const auto expected = outline_by_definition(points, alpha);
    EXPECT_EQ(edges_of(shape), expected) << "trial " << trial;
    for (const Polygon& polygon : shape) expect_simple_rings(polygon);
    edges += static_cast<int>(expected.size());
  }
  EXPECT_GT(edges, 3000);
}

TEST(AlphaShape, FindsARectangleWithItsWindow) {
  for (const bool thin : {false, true}) {
    auto asked = options(0.3, thin);
    asked.min_hole_m2 = 0.2;
    const auto shape = alpha_shape(wall_with_window(7, 30000), asked);
    ASSERT_EQ(shape.size(), 1U);
    ASSERT_EQ(shape[0].holes.size(), 1U);
    EXPECT_NEAR(signed_area(shape[0].outer), 24.0, 0.3);
    // The disc does not reach the window's corners: a chord cuts off half a square of side alpha at each.
    EXPECT_NEAR(signed_area(shape[0].holes[0]), -(1.5 - 4.0 * 0.5 * 0.3 * 0.3), 0.05);
    EXPECT_FALSE(contains(shape[0], Vector2d(2.5, 1.7)));
    EXPECT_TRUE(contains(shape[0], Vector2d(1.0, 1.7)));
  }
}

TEST(AlphaShape, ThinningMovesTheOutlineByLessThanHalfACell) {
  const auto points = wall_with_window(11, 60000);
  const auto fine = alpha_shape(points, options(0.3, false));
  const auto thin = alpha_shape(points, options(0.3, true));
  ASSERT_EQ(fine.size(), 1U);
  ASSERT_EQ(thin.size(), 1U);
  const double outline_m = 20.0 + 5.0;
  EXPECT_NEAR(area(fine), area(thin), 0.5 * 0.075 * outline_m);
  EXPECT_LT(thinned(points, 0.075).size(), points.size() / 8);
}

TEST(AlphaShape, KeepsSeparatePartsLargestFirst) {
  RandomStream random(3);
  std::vector<Vector2d> points;
  for (int i = 0; i < 4000; ++i) {
    points.push_back(uniform_vector(Vector2d(0.0, 0.0), Vector2d(1.0, 2.0), random));
    points.push_back(uniform_vector(Vector2d(3.0, 0.0), Vector2d(6.0, 2.0), random));
  }
  const auto shape = alpha_shape(points, options(0.25, true));
  ASSERT_EQ(shape.size(), 2U);
  EXPECT_NEAR(area(shape[0]), 6.0, 0.2);
  EXPECT_NEAR(area(shape[1]), 2.0, 0.1);
  auto asked = options(0.25, true);
  asked.min_part_m2 = 3.0;
  EXPECT_EQ(alpha_shape(points, asked).size(), 1U);
}

TEST(AlphaShape, MakesAnIslandInsideAHoleAPartOfItsOwn) {
  std::vector<Vector2d> points;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const Vector2d p(0.1 * i, 0.1 * j);
      if (!in_rectangle(p, 0.95, 0.95, 5.05, 5.05) || in_rectangle(p, 2.45, 2.45, 3.55, 3.55)) {
        points.push_back(p);
      }
    }
  }
  const auto shape = alpha_shape(points, options(0.15, false));
  ASSERT_EQ(shape.size(), 2U);
  ASSERT_EQ(shape[0].holes.size(), 1U);
  EXPECT_NEAR(area(shape[0]), 36.0 - (4.2 * 4.2 - 4.0 * 0.005), 1e-3);
  EXPECT_NEAR(area(shape[1]), 1.0, 1e-3);
}

TEST(AlphaShape, SplitsRingsThatTouchInAPoint) {
  // Two triangles that share one corner; and a square whose hole reaches its outline in one point.
  const std::vector<Vector2d> bow_tie{{0.0, 0.0}, {-1.0, 0.4}, {-1.0, -0.4}, {1.0, 0.4}, {1.0, -0.4}};
  const auto shape = alpha_shape(bow_tie, options(0.6, false));
  ASSERT_EQ(shape.size(), 2U);
  for (const Polygon& part : shape) {
    EXPECT_EQ(part.outer.size(), 3U);
    EXPECT_NEAR(area(part), 0.4, 1e-4);
  }

  std::vector<Vector2d> diamond;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      if (std::abs(i) + std::abs(j - 5) >= 5) diamond.emplace_back(0.1 * i, 0.1 * j);
    }
  }
  const auto pierced = alpha_shape(diamond, options(0.08, false));
  ASSERT_EQ(pierced.size(), 1U);
  ASSERT_EQ(pierced[0].holes.size(), 1U);
  expect_simple_rings(pierced[0]);
  EXPECT_NEAR(area(pierced[0]), 4.0 - 0.5, 1e-3);
}

TEST(AlphaShape, OfDegenerateSetsIsEmpty) {
  const auto shape_of = [](const std::vector<Vector2d>& points) {
    const std::size_t parts = alpha_shape(points, options(1.0, true)).size();
    EXPECT_EQ(alpha_shape(points, options(1.0, false)).size(), parts);
    return parts;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(shape_of({}), 0U);
  EXPECT_EQ(shape_of({{1.0, 1.0}, {1.5, 1.0}}), 0U);
  EXPECT_EQ(shape_of(std::vector<Vector2d>(50, Vector2d(2.0, 3.0))), 0U);
  EXPECT_EQ(shape_of({{nan, 0.0}, {0.0, nan}, {INFINITY, 1.0}, {1e300, 1.0}}), 0U);
  std::vector<Vector2d> line;
  for (int i = 0; i < 100; ++i) line.emplace_back(0.1 * i, 0.2 * i);
  EXPECT_EQ(shape_of(line), 0U);
  line.emplace_back(0.5, 0.0);
  EXPECT_EQ(shape_of(line), 1U);
  EXPECT_EQ(shape_of({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {nan, 0.5}}), 1U);
  EXPECT_EQ(shape_of({{0.0, 0.0}, {1e11, 0.0}, {0.0, 1e11}}), 0U);
}

TEST(AlphaShape, KeepsDigitsFarFromTheOrigin) {
  auto points = wall_with_window(5, 5000);
  const double near = area(alpha_shape(points, options(0.3, true)));
  for (Vector2d& p : points) p += Vector2d(1024.0e3, 6840.0e3);
  EXPECT_NEAR(area(alpha_shape(points, options(0.3, true))), near, 0.02);
}

TEST(AlphaShape, RefusesOptionsOutOfBounds) {
  EXPECT_THROW(alpha_shape({}, options(0.0, true)), Error);
  EXPECT_THROW(alpha_shape({}, options(std::nan(""), true)), Error);
  EXPECT_THROW(thinned({}, 0.0), Error);
}

TEST(Thinned, LeavesAPointWithinThreeCellsOfEachAndAllOfASparseSet) {
  RandomStream random(9);
  std::vector<Vector2d> points;
  for (int i = 0; i < 5000; ++i)
    points.push_back(uniform_vector(Vector2d(-2.0, -2.0), Vector2d(2.0, 2.0), random));
  const auto kept = thinned(points, 0.1);
  EXPECT_LT(kept.size(), points.size() / 2);
  for (const Vector2d& p : points) {
    double nearest = INFINITY;
    for (const std::uint32_t i : kept) nearest = std::min(nearest, (points[i] - p).norm());
    EXPECT_LT(nearest, 0.29);
  }
  EXPECT_EQ(thinned(points, 1e-4).size(), points.size());
}

}  // namespace
}  // namespace limen
