// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/polygon_clip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

struct Rect {
  double x0, y0, x1, y1;
  [[nodiscard]] double area() const { return std::max(0.0, x1 - x0) * std::max(0.0, y1 - y0); }
  [[nodiscard]] Ring ring() const { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }
  [[nodiscard]] Polygon polygon() const { return {ring(), {}}; }
};

Rect overlap(const Rect& a, const Rect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

Rect random_rect(RandomStream& random) {
  const double x = random.uniform(-5.0, 5.0);
  const double y = random.uniform(-5.0, 5.0);
  return {x, y, x + random.uniform(0.1, 6.0), y + random.uniform(0.1, 6.0)};
}

/// A star-shaped ring with `corners` corners about a centre.
Ring random_star(RandomStream& random, int corners) {
  const Vector2d centre = uniform_vector(Vector2d(-2.0, -2.0), Vector2d(2.0, 2.0), random);
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + random.uniform(0.0, 0.9)) / corners;
    ring.push_back(centre + random.uniform(0.3, 3.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

Polygon random_pierced(RandomStream& random) {
  Polygon polygon{random_star(random, 9), {}};
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : polygon.outer) middle += p / static_cast<double>(polygon.outer.size());
  Ring hole;
  for (const Vector2d& p : polygon.outer) hole.push_back(middle + 0.2 * (p - middle));
  std::reverse(hole.begin(), hole.end());
  polygon.holes.push_back(hole);
  return polygon;
}

TEST(PolygonClip, RectanglesMeetAsTheirFormulaSays) {
  RandomStream random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const Rect a = random_rect(random);
    const Rect b = random_rect(random);
    const double expected = overlap(a, b).area();
    EXPECT_NEAR(intersection_area({a.polygon()}, {b.polygon()}), expected, 3e-4);
    EXPECT_NEAR(area(intersection({a.polygon()}, {b.polygon()})), expected, 3e-4);
    EXPECT_NEAR(area(difference({a.polygon()}, {b.polygon()})), a.area() - expected, 3e-4);
    EXPECT_NEAR(union_area({a.polygon(), b.polygon()}), a.area() + b.area() - expected, 5e-4);
  }
}

TEST(PolygonClip, PartsOfASetAddUpToIt) {
  RandomStream random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const std::vector<Polygon> a = merged({random_pierced(random), random_pierced(random)});
    const std::vector<Polygon> b = merged({random_pierced(random), random_pierced(random)});
    const double common = intersection_area(a, b);
    EXPECT_NEAR(common + area(difference(a, b)), area(a), 1e-3);
    EXPECT_NEAR(common, intersection_area(b, a), 1e-6);
    EXPECT_NEAR(area(merged(a, b)) + common, area(a) + area(b), 1e-3);
    EXPECT_NEAR(area(intersection(a, b)), common, 1e-6);
    EXPECT_LE(common, std::min(area(a), area(b)) + 1e-6);
  }
}

TEST(PolygonClip, HonoursHolesWhicheverWayTheirRingsRun) {
  const Rect wall{0.0, 0.0, 6.0, 4.0};
  const Rect window{2.0, 1.0, 3.0, 2.5};
  Ring clockwise = window.ring();
  std::reverse(clockwise.begin(), clockwise.end());
  Ring wall_backwards = wall.ring();
  std::reverse(wall_backwards.begin(), wall_backwards.end());
  const Rect probe{2.5, 0.0, 6.0, 4.0};
  for (const Ring& outer : {wall.ring(), wall_backwards}) {
    for (const Ring& hole : {window.ring(), clockwise}) {
      EXPECT_NEAR(intersection_area({{outer, {hole}}}, {probe.polygon()}), 14.0 - 0.75, 1e-4);
    }
  }
  const auto cut = intersection({{wall.ring(), {clockwise}}}, {Rect{1.0, 0.5, 4.0, 3.0}.polygon()});
  ASSERT_EQ(cut.size(), 1U);
  ASSERT_EQ(cut[0].holes.size(), 1U);
  EXPECT_GT(signed_area(cut[0].outer), 0.0);
  EXPECT_NEAR(signed_area(cut[0].holes[0]), -1.5, 1e-4);
}

TEST(PolygonClip, OverlappingPolygonsOfOneArgumentCountOnce) {
  const Rect a{0.0, 0.0, 2.0, 2.0};
  const Rect b{1.0, 0.0, 3.0, 2.0};
  EXPECT_NEAR(intersection_area({a.polygon(), b.polygon(), a.polygon()}, {Rect{0, 0, 9, 1}.polygon()}), 3.0,
              1e-4);
  EXPECT_NEAR(union_area({a.polygon(), b.polygon()}), 6.0, 1e-4);
}

TEST(PolygonClip, IslandsComeBackAsPolygonsOfTheirOwn) {
  const auto ring_with_island = merged(difference({Rect{0, 0, 5, 5}.polygon()}, {Rect{1, 1, 4, 4}.polygon()}),
                                       {Rect{2, 2, 3, 3}.polygon()});
  ASSERT_EQ(ring_with_island.size(), 2U);
  EXPECT_NEAR(area(ring_with_island[0]), 16.0, 1e-4);
  EXPECT_NEAR(area(ring_with_island[1]), 1.0, 1e-4);
  const auto whole = filled(ring_with_island);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_TRUE(whole[0].holes.empty());
  EXPECT_NEAR(area(whole), 25.0, 1e-4);
}

TEST(PolygonClip, GrowsAndShrinks) {
  const std::vector<Polygon> square{Rect{0, 0, 2, 2}.polygon()};
  EXPECT_NEAR(area(grown(square, 0.5)), 9.0, 1e-3);
  EXPECT_NEAR(area(grown(square, -0.5)), 1.0, 1e-3);
  EXPECT_TRUE(grown(square, -1.5).empty());
}

TEST(PolygonClip, KeepsDigitsOnTheNationalGrid) {
  const Vector2d far(1.05e6, 6.84e6);
  const auto moved = [&](Rect r) {
    return Rect{r.x0 + far.x(), r.y0 + far.y(), r.x1 + far.x(), r.y1 + far.y()}.polygon();
  };
  EXPECT_NEAR(intersection_area({moved({0, 0, 2, 2})}, {moved({1, 1, 3, 3})}), 1.0, 1e-4);
}

TEST(PolygonClip, EmptyAndDegenerateAreasHaveNoOverlap) {
  const std::vector<Polygon> square{Rect{0, 0, 2, 2}.polygon()};
  EXPECT_EQ(intersection_area({}, square), 0.0);
  EXPECT_EQ(intersection_area(square, {Polygon{}}), 0.0);
  EXPECT_EQ(intersection_area(square, {{{{0, 0}, {1, 1}}, {}}}), 0.0);
  EXPECT_EQ(intersection_area(square, {{{{0, 0}, {1, 1}, {2, 2}}, {}}}), 0.0);
  EXPECT_EQ(intersection_area(square, {Rect{2, 0, 4, 2}.polygon()}), 0.0);
  EXPECT_TRUE(intersection(square, {Rect{5, 5, 6, 6}.polygon()}).empty());
  EXPECT_TRUE(merged({}).empty());
}

TEST(PolygonClip, RefusesCoordinatesThatAreNoNumbers) {
  const std::vector<Polygon> square{Rect{0, 0, 2, 2}.polygon()};
  EXPECT_THROW(intersection_area(square, {Rect{0, 0, std::nan(""), 1}.polygon()}), Error);
  EXPECT_THROW(merged(square, {Rect{0, 0, 1e30, 1}.polygon()}), Error);
}

TEST(SimplifyRing, KeepsTheCornersAndTheOutlineWithinTheTolerance) {
  RandomStream random(4);
  Ring noisy;
  const Ring corners = Rect{0, 0, 3, 2}.ring();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d a = corners[i];
    const Vector2d b = corners[(i + 1) % 4];
    for (int k = 0; k < 40; ++k) {
      const double noise = k == 0 ? 0.0 : random.uniform(-0.01, 0.01);
      noisy.push_back(a + (b - a) * (k / 40.0) + noise * Vector2d(-(b - a).y(), (b - a).x()).normalized());
    }
  }
  const Ring simple = simplify_ring(noisy, 0.03);
  EXPECT_EQ(simple.size(), 4U);
  EXPECT_NEAR(signed_area(simple), 6.0, 0.1);
  EXPECT_GT(simplify_ring(noisy, 1e-3).size(), 60U);
  EXPECT_EQ(simplify_ring(noisy, 0.0).size(), noisy.size());
  EXPECT_TRUE(simplify_ring(noisy, 10.0).empty());
  EXPECT_TRUE(simplify_ring({{0, 0}, {1, 1}}, 0.1).empty());
  EXPECT_TRUE(simplify_ring(Ring(5, Vector2d(1, 1)), 0.1).empty());
  EXPECT_THROW(simplify_ring(noisy, -1.0), Error);
}

TEST(Projected, MovesAPolygonIntoAnotherFrame) {
  const Plane wall{Vector3d(1.0, 0.0, 0.0), 2.0};
  const PlaneFrame frame = make_frame(wall, Vector3d(0.0, 1.0, 1.0));
  const PlaneFrame other = make_frame(wall.flipped(), Vector3d(0.0, -3.0, 5.0));
  const std::vector<Polygon> door{Rect{0, 0, 1, 2}.polygon()};
  const auto seen = projected(door, frame, other);
  EXPECT_NEAR(area(seen), 2.0, 1e-12);
  EXPECT_LT(signed_area(seen[0].outer), 0.0);
  EXPECT_LT((other.to_space(seen[0].outer[2]) - frame.to_space(door[0].outer[2])).norm(), 1e-12);
  const Rigid3 tilt{rotation_exp(Vector3d(0.0, std::numbers::pi / 3.0, 0.0)), Vector3d(1.0, 2.0, 3.0)};
  EXPECT_NEAR(area(projected(door, frame, frame, tilt)), 1.0, 1e-12);
}

/// A star of an odd number of corners: each side crosses nearly all others.
Ring star(int corners) {
  Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = std::numbers::pi * (corners - 1.0) / corners * k;
    ring.emplace_back(10.0 * std::cos(angle), 10.0 * std::sin(angle));
  }
  return ring;
}

TEST(PolygonClip, RingsThatCrossAMillionTimesAreRefused) {
  EXPECT_NO_THROW((void)merged({{star(101), {}}}));
  EXPECT_THROW((void)merged({{star(3001), {}}}), Error);
  EXPECT_THROW((void)union_area({{star(3001), {}}}), Error);
  std::vector<Polygon> bars;
  for (int k = 0; k < 1100; ++k) {
    bars.push_back(Rect{0.01 * k, 0.0, 0.01 * k + 0.005, 11.0}.polygon());
    bars.push_back(Rect{0.0, 0.01 * k, 11.0, 0.01 * k + 0.005}.polygon());
  }
  EXPECT_THROW((void)merged(bars), Error);
}

TEST(PolygonClip, RingsOfManyCornersThatDoNotCrossAreTaken) {
  constexpr int kTeeth = 3000;
  Ring comb{{0.0, -1.0}};
  for (int k = 0; k < kTeeth; ++k) {
    comb.emplace_back(0.001 * k, 0.0);
    comb.emplace_back(0.001 * k + 0.0005, 1.0);
  }
  comb.emplace_back(0.001 * kTeeth, -1.0);
  std::reverse(comb.begin(), comb.end());
  EXPECT_NEAR(area(merged({{comb, {}}})), std::abs(signed_area(comb)), 1e-3);
}

TEST(PolygonClip, CanBeStopped) {
  Monitor monitor;
  const CancelScope scope(monitor);
  monitor.cancel();
  EXPECT_THROW((void)merged({Rect{0, 0, 1, 1}.polygon()}), Error);
}

}  // namespace
}  // namespace limen
