// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/delaunay.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr double kAnyRadius = 1 << 25;

std::vector<GridPoint> scattered(std::size_t count, std::int32_t size, std::uint64_t seed) {
  RandomStream random(seed);
  std::set<GridPoint> points;
  while (points.size() < count)
    points.insert({static_cast<std::int32_t>(random.uniform(-size, size)),
                   static_cast<std::int32_t>(random.uniform(-size, size))});
  return {points.begin(), points.end()};
}

double cross(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (static_cast<double>(b.x) - a.x) * (static_cast<double>(c.y) - a.y) -
         (static_cast<double>(b.y) - a.y) * (static_cast<double>(c.x) - a.x);
}

struct Circle {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
};

Circle circle_through(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const double bx = static_cast<double>(b.x) - a.x;
  const double by = static_cast<double>(b.y) - a.y;
  const double cx = static_cast<double>(c.x) - a.x;
  const double cy = static_cast<double>(c.y) - a.y;
  const double d = 2.0 * (bx * cy - by * cx);
  const double x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
  const double y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
  return {a.x + x, a.y + y, std::hypot(x, y)};
}

using Corners = std::array<std::int32_t, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Every three points whose circle is empty.
std::set<Corners> by_brute_force(const std::vector<GridPoint>& points, double most_radius) {
  std::set<Corners> faces;
  const auto n = static_cast<std::int32_t>(points.size());
  const auto at = [&](std::int32_t i) { return points[static_cast<std::size_t>(i)]; };
  for (std::int32_t i = 0; i < n; ++i) {
    for (std::int32_t j = i + 1; j < n; ++j) {
      for (std::int32_t k = j + 1; k < n; ++k) {
        if (cross(at(i), at(j), at(k)) == 0.0) continue;
        const Circle circle = circle_through(at(i), at(j), at(k));
        const bool empty = std::none_of(points.begin(), points.end(), [&](const GridPoint& p) {
          return std::hypot(p.x - circle.x, p.y - circle.y) < circle.radius - 1e-3;
        });
        if (empty && circle.radius <= most_radius) faces.insert({i, j, k});
      }
    }
  }
  return faces;
}

std::set<Corners> corners_of(const std::vector<DelaunayFace>& faces) {
  std::set<Corners> all;
  for (const DelaunayFace& face : faces) all.insert(sorted(face.corners));
  EXPECT_EQ(all.size(), faces.size());
  return all;
}

TEST(Delaunay, IsThatOfEmptyCircles) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<GridPoint> points = scattered(30, 1000000, seed);
    for (const double radius : {kAnyRadius, 400000.0, 150000.0})
      EXPECT_EQ(corners_of(delaunay_faces(points, radius)), by_brute_force(points, radius)) << seed;
  }
}

TEST(Delaunay, NeighboursShareAnEdgeAndFacesTurnLeft) {
  const std::vector<GridPoint> points = scattered(5000, 60000000, 3);
  const std::vector<DelaunayFace> faces = delaunay_faces(points, 1500000.0);
  ASSERT_GT(faces.size(), 4000U);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const DelaunayFace& face = faces[f];
    const auto corner = [&](std::size_t k) { return face.corners[k % 3]; };
    const auto at = [&](std::size_t k) { return points[static_cast<std::size_t>(corner(k))]; };
    EXPECT_GT(cross(at(0), at(1), at(2)), 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      if (face.across[k] == DelaunayFace::kNone) continue;
      const DelaunayFace& other = faces[static_cast<std::size_t>(face.across[k])];
      std::size_t back = 0;
      while (back < 3 && other.across[back] != static_cast<std::int32_t>(f)) ++back;
      ASSERT_LT(back, 3U);
      EXPECT_EQ(other.corners[(back + 1) % 3], corner(k + 2));
      EXPECT_EQ(other.corners[(back + 2) % 3], corner(k + 1));
    }
  }
}

TEST(Delaunay, LatticesAndLinesHaveNoTooManyFaces) {
  // Whatever diagonals are chosen, a lattice has two faces for each of its squares.
  std::vector<GridPoint> lattice;
  for (std::int32_t x = 0; x < 40; ++x) {
    for (std::int32_t y = 0; y < 25; ++y) lattice.push_back({1000 * x, 1000 * y});
  }
  EXPECT_EQ(delaunay_faces(lattice, 1000.0).size(), 2U * 39U * 24U);
  EXPECT_TRUE(delaunay_faces(lattice, 700.0).empty());
  std::vector<GridPoint> line;
  for (std::int32_t x = 0; x < 100; ++x) line.push_back({-3 * x, 7 * x});
  std::sort(line.begin(), line.end());
  EXPECT_TRUE(delaunay_faces(line, kAnyRadius).empty());
}

TEST(Delaunay, FewPointsHaveNoFaces) {
  EXPECT_TRUE(delaunay_faces({}, 10.0).empty());
  EXPECT_TRUE(delaunay_faces({{1, 1}}, 10.0).empty());
  EXPECT_TRUE(delaunay_faces({{1, 1}, {2, 5}}, 10.0).empty());
  EXPECT_EQ(delaunay_faces({{1, 1}, {2, 5}, {4, 0}}, 10.0).size(), 1U);
}

}  // namespace
}  // namespace limen
