// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/settle_planes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// A floor and a wall that meet at y = 0, 5 000 points each, 2 mm noise.
struct Corner {
  std::vector<Vector3d> points;
  MortonOrder sorted;
  PointNormals normals;
  SettleGrid grid;
  SettleScene scene;

  Corner()
      : points(corner()),
        sorted(morton_order(points, 0.02)),
        normals(sorted, 0.005),
        grid(sorted, 0.08),
        scene{sorted, normals, grid} {}

  static std::vector<Vector3d> corner() {
    RandomStream random(1);
    std::vector<Vector3d> points;
    for (int i = 0; i < 5000; ++i)
      points.emplace_back(random.uniform(), random.uniform(), 0.002 * random.normal());
    for (int i = 0; i < 5000; ++i)
      points.emplace_back(random.uniform(), 0.002 * random.normal(), random.uniform());
    return points;
  }
  [[nodiscard]] bool on_floor(std::size_t k) const { return sorted.index(k) < 5000; }

  [[nodiscard]] std::vector<PointMoments> sums(const std::vector<std::int32_t>& labels,
                                               std::size_t planes) const {
    std::vector<PointMoments> sums(planes);
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (labels[k] >= 0) sums[static_cast<std::size_t>(labels[k])].add(sorted.point(k));
    }
    return sums;
  }
};

TEST(PointNormals, TellTheWayASurfaceFaces) {
  const Corner corner;
  std::size_t known = 0;
  std::size_t right = 0;
  for (std::uint32_t k = 0; k < corner.sorted.size(); ++k) {
    const Vector3d* const normal = corner.normals.at(k);
    if (normal == nullptr) continue;
    EXPECT_FALSE(corner.normals.rough(k));
    ++known;
    if (std::abs(corner.on_floor(k) ? normal->z() : normal->y()) > 0.97) ++right;
  }
  EXPECT_GT(known, 7000U);
  EXPECT_GT(right, known * 97 / 100);
}

TEST(SettlePlanes, BordersComeRight) {
  const Corner corner;
  // The floor has taken all points within 6 cm of it, of the wall too; a third of the wall is free.
  std::vector<std::int32_t> labels(corner.sorted.size());
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const double height = corner.sorted.point(k).z() + corner.sorted.anchor.z();
    labels[k] = corner.on_floor(k) || height < 0.06 ? 0 : k % 3 == 0 ? -1 : 1;
  }
  const SettleOptions options{.threshold_m = 0.008};
  for (int round = 0; round < 2; ++round)
    labels = settled(corner.scene, labels, corner.sums(labels, 2), options);
  std::size_t right = 0;
  for (std::size_t k = 0; k < labels.size(); ++k)
    right += labels[k] == (corner.on_floor(k) ? 0 : 1) ? 1U : 0U;
  EXPECT_GT(right, labels.size() * 97 / 100);
}

TEST(SettlePlanes, APlaneThroughAnEdgeIsExplained) {
  const Corner corner;
  // A third plane made of what lies close to the edge.
  std::vector<std::int32_t> labels(corner.sorted.size());
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const Vector3d x = corner.sorted.point(k) + corner.sorted.anchor;
    labels[k] = std::abs(x.y()) < 0.03 && x.z() < 0.03 ? 2 : corner.on_floor(k) ? 0 : 1;
  }
  const auto shares =
      explained_shares(corner.scene, labels, corner.sums(labels, 3), SettleOptions{.threshold_m = 0.008});
  ASSERT_EQ(shares.size(), 3U);
  EXPECT_GT(shares[2], 0.9);
  EXPECT_LT(shares[0], 0.05);
  EXPECT_LT(shares[1], 0.05);
}

}  // namespace
}  // namespace limen
