// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/fine_station.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/extract/planes/detect_planes.h"
#include "limen/extract/planes/split_at_steps.h"

namespace limen {
namespace {

constexpr double kRangeNoiseM = 0.003;

/// A station's scan that is built face by face, seen from 3 m before the wall y = 0; `face` tells which is
/// which.
struct StationScan {
  Scan scan;
  std::vector<int> face;
  RandomStream random{1, 0};

  StationScan() {
    scan.level = true;
    scan.centres = {Vector3d(0.0, -3.0, 1.5)};
  }
  /// Points of a face spanned from a corner, evenly and at random.
  void add(int name, const Vector3d& corner, const Vector3d& a, const Vector3d& b, double per_m2) {
    const Vector3d across = a.cross(b).normalized();
    const int points = static_cast<int>(per_m2 * a.cross(b).norm());
    for (int i = 0; i < points; ++i) {
      const double u = random.uniform(0.0, 1.0);
      const double v = random.uniform(0.0, 1.0);
      scan.points.emplace_back(corner + u * a + v * b + kRangeNoiseM * random.normal() * across);
      face.push_back(name);
    }
  }
  [[nodiscard]] std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> points;
    for (std::size_t i = 0; i < scan.size(); ++i) points.push_back(static_cast<std::uint32_t>(i));
    return points;
  }
  /// How many points of each face are in which plane: the most of a face in one plane, over all of its
  /// points.
  [[nodiscard]] double found(int name, const std::vector<std::int32_t>& labels) const {
    std::map<std::int32_t, int> counts;
    int all = 0;
    int most = 0;
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (face[i] != name) continue;
      ++all;
      if (labels[i] >= 0) most = std::max(most, ++counts[labels[i]]);
    }
    return static_cast<double>(most) / all;
  }
};

PlaneFit plane_y(double y) {
  PlaneFit fit;
  fit.plane = {Vector3d::UnitY(), y};
  fit.centroid = Vector3d(0.0, y, 1.0);
  return fit;
}

/// A frame 5 cm wide all round a pane, and a mullion in its middle, 4 mm behind.
StationScan framed_window() {
  StationScan window;
  window.add(0, {-0.6, 0.0, 0.5}, {0.05, 0.0, 0.0}, {0.0, 0.0, 1.2}, 40000);
  window.add(0, {0.55, 0.0, 0.5}, {0.05, 0.0, 0.0}, {0.0, 0.0, 1.2}, 40000);
  window.add(0, {-0.55, 0.0, 0.5}, {1.1, 0.0, 0.0}, {0.0, 0.0, 0.05}, 40000);
  window.add(0, {-0.55, 0.0, 1.65}, {1.1, 0.0, 0.0}, {0.0, 0.0, 0.05}, 40000);
  window.add(1, {-0.025, 0.004, 0.55}, {0.05, 0.0, 0.0}, {0.0, 0.0, 1.1}, 40000);
  return window;
}

std::vector<std::int32_t> labels_of(const std::vector<std::vector<std::uint32_t>>& parts, std::size_t size) {
  std::vector<std::int32_t> labels(size, -1);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const std::uint32_t i : parts[k]) labels[i] = static_cast<std::int32_t>(k);
  }
  return labels;
}

TEST(SplitAtSteps, AMullionFourMillimetresBehindItsFrameIsAnotherPlane) {
  const StationScan window = framed_window();
  const auto parts = split_at_steps(window.scan, plane_y(0.001), window.all(), {});
  ASSERT_EQ(parts.size(), 2U);
  const std::vector<std::int32_t> labels = labels_of(parts, window.scan.size());
  EXPECT_GT(window.found(0, labels), 0.93);
  EXPECT_GT(window.found(1, labels), 0.93);
}

TEST(SplitAtSteps, AFlatWallStaysWholeAlsoInPartsThatDoNotTouch) {
  StationScan wall;
  wall.add(0, {-3.0, 0.0, 0.0}, {2.5, 0.0, 0.0}, {0.0, 0.0, 2.8}, 8000);
  wall.add(0, {0.5, 0.0, 0.0}, {2.5, 0.0, 0.0}, {0.0, 0.0, 2.8}, 8000);
  const auto parts = split_at_steps(wall.scan, plane_y(0.0), wall.all(), {});
  EXPECT_LE(parts.size(), 2U);
  const auto larger = std::max_element(parts.begin(), parts.end(),
                                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  ASSERT_NE(larger, parts.end());
  EXPECT_GT(larger->size(), 0.99 * static_cast<double>(wall.scan.size()));
}

TEST(SplitAtSteps, AWallThatBulgesHasNoStepAndStaysWhole) {
  StationScan wall;
  wall.add(0, {-3.0, 0.0, 0.0}, {6.0, 0.0, 0.0}, {0.0, 0.0, 2.8}, 4000);
  for (Vector3d& x : wall.scan.points) x.y() += 0.007 * std::cos(x.x() / 3.0 * 3.1416);
  const auto largest = [&](double step_m) {
    const auto parts = split_at_steps(wall.scan, plane_y(0.0), wall.all(), {.step_m = step_m});
    std::size_t most = 0;
    for (const auto& part : parts) most = std::max(most, part.size());
    return static_cast<double>(most) / static_cast<double>(wall.scan.size());
  };
  EXPECT_GT(largest(StepOptions{}.step_m), 0.9);
  EXPECT_LT(largest(0.0), 0.7);
}

TEST(CoherentLabels, PointsChooseAsThoseAroundThemWhereNoiseIsAsLargeAsTheStep) {
  const StationScan window = framed_window();
  const MortonOrder order = morton_order(window.scan.points, 0.02);
  const SettleGrid grid(order, 0.04);
  const PointNormals normals(order, 0.006);
  std::vector<std::int32_t> labels(order.size());
  std::vector<PointMoments> sums(2);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int own = window.face[order.index(k)];
    labels[k] = window.scan.points[order.index(k)].y() < 0.002 ? 0 : 1;  // by distance
    if (labels[k] != own) ++wrong;
    sums[static_cast<std::size_t>(labels[k])].add(order.point(k));
  }
  ASSERT_GT(wrong, order.size() / 5);
  for (int round = 0; round < 4; ++round)
    coherent_labels({order, normals, grid}, {.threshold_m = 0.01, .noise_m = kRangeNoiseM}, labels, sums);
  wrong = 0;
  PointMoments first;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (labels[k] != window.face[order.index(k)]) ++wrong;
    if (labels[k] == 0) first.add(order.point(k));
  }
  EXPECT_LT(wrong, order.size() / 12);
  EXPECT_EQ(sums[0].count, first.count);  // the sums follow
  EXPECT_LT((sums[0].mean() - first.mean()).norm(), 1e-9);
}

/// An open shelf before a wall: boards 25 mm thick whose front edges lie in one plane.
StationScan shelf() {
  StationScan room;
  room.add(0, {-2.0, 0.4, 0.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, 2.8}, 20000);
  for (int k = 0; k < 5; ++k) {
    const double z = 0.3 + 0.3 * k;
    room.add(10 + k, {-0.6, 0.0, z}, {1.2, 0.0, 0.0}, {0.0, 0.38, 0.0}, 20000);
    room.add(1, {-0.6, 0.0, z - 0.025}, {1.2, 0.0, 0.0}, {0.0, 0.0, 0.025}, 30000);
  }
  return room;
}

TEST(FineStation, TheFrontEdgesOfAShelfsBoardsAreAPlane) {
  const StationScan room = shelf();
  const auto share = [&](bool relief) {
    const DetectedPlanes found = detect_planes(room.scan, {.relief = relief});
    return room.found(1, found.planes.labels);
  };
  EXPECT_LT(share(false), 0.2);
  EXPECT_GT(share(true), 0.4);
}

TEST(FineStation, LabelsAreOfThePlanesAndThesePlanesHoldEnough) {
  const StationScan room = shelf();
  const DetectedPlanes found = detect_planes(room.scan, {}, {.min_inliers = 300});
  ASSERT_FALSE(found.planes.fits.empty());
  std::vector<PointMoments> sums(found.planes.fits.size());
  for (std::size_t i = 0; i < room.scan.size(); ++i) {
    const std::int32_t label = found.planes.labels[i];
    if (label >= 0) sums[static_cast<std::size_t>(label)].add(room.scan.points[i]);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    EXPECT_GE(sums[k].count, 300.0);
    EXPECT_LT((sums[k].mean() - found.planes.fits[k].centroid).norm(), 1e-9);
    EXPECT_LE(sums[k].count, sums[k == 0 ? 0 : k - 1].count);
  }
}

TEST(FineStation, OfNothing) {
  const Scan scan;
  EXPECT_TRUE(fine_station_planes(scan, MortonOrder{}, GrownPlanes{}, {}).fits.empty());
  EXPECT_TRUE(detect_planes(scan).planes.fits.empty());
}

}  // namespace
}  // namespace limen
