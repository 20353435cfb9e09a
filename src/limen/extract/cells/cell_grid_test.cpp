// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

std::vector<Vector3d> cloud(std::size_t count, double size, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(uniform_vector(Vector3d(0, 0, 0), Vector3d(size, size, size), random));
  return points;
}

TEST(MortonOrder, CodesAndBack) {
  RandomStream random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = random.below(1U << 21U);
    const std::uint32_t y = random.below(1U << 21U);
    const std::uint32_t z = random.below(1U << 21U);
    const CellIndex cell = morton_decode(morton_encode(x, y, z));
    EXPECT_EQ(cell.x, x);
    EXPECT_EQ(cell.y, y);
    EXPECT_EQ(cell.z, z);
  }
  EXPECT_EQ(morton_encode(1, 0, 0), 1U);
  EXPECT_EQ(morton_encode(0, 1, 0), 2U);
  EXPECT_EQ(morton_encode(0, 0, 1), 4U);
  EXPECT_EQ(morton_encode(2, 0, 0), 8U);
}

TEST(MortonOrder, SortsStablyWhateverTheThreads) {
  const std::vector<Vector3d> points = cloud(20000, 1.0, 2);
  set_thread_count(1);
  const MortonOrder one = morton_order(points, 0.1);
  set_thread_count(3);
  const MortonOrder three = morton_order(points, 0.1);
  set_thread_count(0);
  EXPECT_EQ(one.indices, three.indices);
  EXPECT_TRUE(std::is_sorted(one.codes.begin(), one.codes.end()));
  std::vector<std::uint32_t> seen = one.indices;
  std::sort(seen.begin(), seen.end());
  for (std::uint32_t i = 0; i < seen.size(); ++i) ASSERT_EQ(seen[i], i);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_LT((one.point(k) + one.anchor - points[one.indices[k]]).norm(), 1e-12);
    if (k > 0 && one.codes[k] == one.codes[k - 1]) {
      EXPECT_LT(one.indices[k - 1], one.indices[k]);
    }
  }
}

TEST(MortonOrder, PointsThatLieAlongTheCurveAlreadyNeedNoOrder) {
  const std::vector<Vector3d> points = cloud(5000, 1.0, 2);
  const MortonOrder first = morton_order(points, 0.01);
  std::vector<Vector3d> along;
  for (std::size_t k = 0; k < first.size(); ++k) along.push_back(points[first.index(k)]);
  const MortonOrder again = morton_order(along, 0.02);
  EXPECT_TRUE(again.indices.empty());
  EXPECT_EQ(again.index(7), 7U);
  EXPECT_EQ(again.point(7), along[7] - again.anchor);
}

TEST(MortonOrder, TakesAnyExtent) {
  EXPECT_TRUE(morton_order({}, 0.02).indices.empty());
  EXPECT_EQ(morton_order({Vector3d(1, 2, 3)}, 0.02).codes, std::vector<std::uint64_t>{0});
  std::vector<Vector3d> points = cloud(1000, 1.0, 3);
  points.emplace_back(1e6, 1e6, -1e6);
  const MortonOrder sorted = morton_order(points, 0.02);
  // The cubes of the many keep their size; the stray is clamped to the border.
  std::vector<std::uint64_t> codes(sorted.codes.begin(), sorted.codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  EXPECT_GT(codes.size(), 900U);
}

TEST(CellRuns, NeighboursAreThoseOfACompleteSearch) {
  const std::vector<Vector3d> points = cloud(3000, 1.0, 4);
  const MortonOrder sorted = morton_order(points, 0.05);
  for (const int level : {0, 1, 2}) {
    const CellRuns runs(sorted, level);
    std::uint32_t covered = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      covered += runs.end(i) - runs.begin(i);
      const CellIndex at = morton_decode(runs.code(i));
      std::vector<std::int32_t> expected;
      for (std::size_t j = 0; j < runs.size(); ++j) {
        const CellIndex to = morton_decode(runs.code(j));
        const auto near = [](std::uint32_t a, std::uint32_t b) { return a + 1 >= b && b + 1 >= a; };
        if (i != j && near(at.x, to.x) && near(at.y, to.y) && near(at.z, to.z))
          expected.push_back(static_cast<std::int32_t>(j));
      }
      const CellNeighbours found = runs.neighbours(i);
      std::vector<std::int32_t> indices(found.begin(), found.end());
      std::sort(indices.begin(), indices.end());
      ASSERT_EQ(indices, expected) << "cube " << i << " of level " << level;
    }
    EXPECT_EQ(covered, points.size());
  }
}

TEST(CellGrid, MeasuresThePointsOfItsCubes) {
  // One cube of 0.16 m with a plane of 2 mm noise, tilted.
  RandomStream random(5);
  const Vector3d normal = Vector3d(1, 2, 5).normalized();
  const Vector3d u = normal.unitOrthogonal();
  const Vector3d v = normal.cross(u);
  std::vector<Vector3d> points;
  for (int i = 0; i < 4000; ++i) {
    const double off = 0.002 * random.normal();
    const Vector2d in = uniform_vector(Vector2d(-0.05, -0.05), Vector2d(0.05, 0.05), random);
    points.emplace_back(in.x() * u + in.y() * v + off * normal);
  }
  const MortonOrder sorted = morton_order(points, 0.02);
  std::vector<std::uint32_t> active(points.size());
  std::iota(active.begin(), active.end(), 0U);
  const CellGrid grid(sorted, active, 3);
  ASSERT_EQ(grid.cells().size(), 1U);
  EXPECT_DOUBLE_EQ(grid.edge_m(), 0.16);
  const Cell& cell = grid.cells()[0];
  EXPECT_EQ(cell.count(), 4000U);
  EXPECT_GT(std::abs(grid.shape(cell).normal.dot(normal)), 0.9999);
  EXPECT_NEAR(grid.shape(cell).thickness_m, 0.002, 1e-4);
  EXPECT_NEAR(grid.shape(cell).spread_m, 0.1 / std::sqrt(12.0), 1e-3);
  EXPECT_LT(grid.shape(cell).unevenness_m, 0.001);
}

TEST(CellGrid, AStepIsUneven) {
  RandomStream random(6);
  std::vector<Vector3d> points;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(0.0, 0.16);
    points.emplace_back(x, random.uniform(0.0, 0.16), (x > 0.12 ? 0.012 : 0.0) + 0.001 * random.normal());
  }
  points.emplace_back(0.0, 0.0, -0.05);  // the cube's corner
  const MortonOrder sorted = morton_order(points, 0.02);
  std::vector<std::uint32_t> active(points.size());
  std::iota(active.begin(), active.end(), 0U);
  const CellGrid grid(sorted, active, 3);
  double worst = 0.0;
  for (const Cell& cell : grid.cells()) {
    if (cell.count() > 100) worst = std::max(worst, grid.shape(cell).unevenness_m);
  }
  EXPECT_GT(worst, 0.001);
}

}  // namespace
}  // namespace limen
