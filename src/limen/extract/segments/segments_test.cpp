// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments.h"

#include <algorithm>
#include <cmath>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/segments/segments_borders.h"
#include "limen/extract/segments/segments_image.h"
#include "limen/extract/segments/segments_merge.h"

namespace limen {
namespace {

double distance_to_line(const Segment& line, const Vector3d& x) {
  const Vector3d off = x - line.a;
  return (off - off.dot(line.direction()) * line.direction()).norm();
}

/// Metres of `truth` beside which a segment runs, within 1 cm and 1 degree.
double found_length(const std::vector<Segment>& segments, const Segment& truth) {
  constexpr double kStep = 0.01;
  double found = 0.0;
  for (double t = 0.5 * kStep; t < truth.length(); t += kStep) {
    const Vector3d x = truth.a + t * truth.direction();
    const bool beside = std::any_of(segments.begin(), segments.end(), [&](const Segment& segment) {
      const double along = segment.direction().dot(x - segment.a);
      return std::abs(segment.direction().dot(truth.direction())) > std::cos(radians(1.0)) && along > -0.01 &&
             along < segment.length() + 0.01 && distance_to_line(segment, x) < 0.01;
    });
    if (beside) found += kStep;
  }
  return found;
}

/// The box of synthetic_room.h.
std::vector<Segment> box_edges() {
  const Vector3d low(-2, -3, -1.5);
  const Vector3d high(4, 2, 1.5);
  std::vector<Segment> edges;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Segment edge{low, low};
      const Eigen::Index u = (axis + 1) % 3;
      const Eigen::Index v = (axis + 2) % 3;
      edge.a[u] = edge.b[u] = (corner & 1) != 0 ? high[u] : low[u];
      edge.a[v] = edge.b[v] = (corner & 2) != 0 ? high[v] : low[v];
      edge.b[axis] = high[axis];
      edges.push_back(edge);
    }
  }
  return edges;
}

/// A wall at x = 3 with a hole |y| < 0.6, |z| < 0.7 through which another at x = 6 is seen, and before it a
/// post at x = 1.5, 0.1 m wide about y = 1.2, whose shadow cuts the wall in two. Seen from 0, 0, 0.
Scan window_scan(std::size_t points) {
  RandomStream stream(7);
  Scan scan;
  scan.name = "window";
  while (scan.points.size() < points) {
    const Vector3d ray(1.0, stream.uniform(-0.7, 0.7), stream.uniform(-0.5, 0.5));
    double x = 3.0;
    if (std::abs(3.0 * ray.y()) < 0.6 && std::abs(3.0 * ray.z()) < 0.7) x = 6.0;
    if (std::abs(1.5 * ray.y() - 1.2 * 0.5) < 0.05) x = 1.5;
    const double noise = 1.0 + 0.002 * stream.normal() / (x * ray.norm());
    scan.points.push_back(x * noise * ray);
  }
  scan.centres = {Vector3d::Zero()};
  return scan;
}

std::vector<Segment> segments_of(const Scan& scan, const SegmentOptions& options = {}) {
  return find_segments(scan, extract_features(scan), options);
}

TEST(Segments, TwelveEdgesOfABox) {
  const std::vector<Segment> segments = segments_of(box_scan(120000, radians(-90.0), radians(90.0)));
  EXPECT_EQ(segments.size(), 12U);
  for (const Segment& edge : box_edges()) EXPECT_GT(found_length(segments, edge), 0.94 * edge.length());
}

TEST(Segments, CreasesAreKnownToAMillimetre) {
  const Scan scan = box_scan(120000, radians(-90.0), radians(90.0));
  const std::vector<Segment> truth = box_edges();
  for (const DetectedEdge& edge : find_edges(scan, extract_features(scan))) {
    ASSERT_EQ(edge.kind, EdgeKind::crease);
    double least = 1e9;
    for (const Segment& line : truth)
      least = std::min(
          least, std::max(distance_to_line(line, edge.segment.a), distance_to_line(line, edge.segment.b)));
    EXPECT_LT(least, 0.0015);
  }
}

TEST(Segments, LongestFirst) {
  const std::vector<Segment> segments = segments_of(box_scan(60000, radians(-90.0), radians(90.0)));
  ASSERT_FALSE(segments.empty());
  for (std::size_t i = 1; i < segments.size(); ++i) EXPECT_GE(segments[i - 1].length(), segments[i].length());
}

TEST(Segments, SidesOfAHoleAreEdges) {
  const std::vector<Segment> segments = segments_of(window_scan(60000));
  const Vector3d corners[4] = {{3, -0.6, -0.7}, {3, 0.6, -0.7}, {3, 0.6, 0.7}, {3, -0.6, 0.7}};
  for (int k = 0; k < 4; ++k) {
    const Segment side{corners[k], corners[(k + 1) % 4]};
    EXPECT_GT(found_length(segments, side), 0.9 * side.length()) << "side " << k;
  }
}

TEST(Segments, ShadowsAreNoEdges) {
  const std::vector<Segment> segments = segments_of(window_scan(60000));
  ASSERT_FALSE(segments.empty());
  for (const double y : {1.1, 1.3}) {
    const Segment shadow{Vector3d(3, y, -1.4), Vector3d(3, y, 1.4)};
    EXPECT_EQ(found_length(segments, shadow), 0.0) << "at y = " << y;
  }
}

TEST(Segments, HolesAreTakenWithoutACentre) {
  Scan scan = window_scan(60000);
  const ExtractedFeatures extracted = extract_features(scan);
  scan.centres.clear();
  const std::vector<Segment> segments = find_segments(scan, extracted);
  EXPECT_GT(found_length(segments, {{3, -0.6, -0.7}, {3, -0.6, 0.7}}), 1.2);
}

TEST(Segments, TheSameForAnyThreadCount) {
  const Scan scan = window_scan(40000);
  const ExtractedFeatures extracted = extract_features(scan);
  std::vector<std::vector<Segment>> results;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    results.push_back(find_segments(scan, extracted));
  }
  set_thread_count(0);
  ASSERT_FALSE(results[0].empty());
  for (const std::vector<Segment>& result : results) {
    ASSERT_EQ(result.size(), results[0].size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      EXPECT_EQ(result[i].a, results[0][i].a);
      EXPECT_EQ(result[i].b, results[0][i].b);
    }
  }
}

TEST(Segments, NothingInNothing) {
  EXPECT_TRUE(find_segments(Scan{}, ExtractedFeatures{}).empty());
}

TEST(Segments, BadOptionsAreNamed) {
  SegmentOptions options;
  options.min_length_m = 0.0;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.min_angle_deg = 91.0;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.join_gap_m = -0.1;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.max_border_sigma_m = std::nan("");
  EXPECT_THROW(options.check(), Error);
}

/// Points of the half plane v > 0, at random or in rows, about `spacing_m` apart.
std::vector<Vector3d> half_plane(double spacing_m, bool rows, std::uint64_t seed) {
  RandomStream stream(seed);
  std::vector<Vector3d> points;
  const auto count = static_cast<int>(2.0 / spacing_m);
  for (int i = 0; i < count; ++i) {
    const double phase = stream.uniform();
    for (int j = 0; j < count / 2; ++j) {
      const double u = rows ? (i + 0.5) * spacing_m : stream.uniform(0.0, 2.0);
      const double v = rows ? (j + phase) * spacing_m : stream.uniform(0.0, 1.0);
      points.emplace_back(u, v, 0.0);
    }
  }
  return points;
}

TEST(SegmentBorders, SpacingIsMadeUpForInRowsAndAtRandom) {
  for (const bool rows : {true, false}) {
    const std::vector<Vector3d> points = half_plane(0.02, rows, 3);
    std::vector<std::uint32_t> all(points.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    const PlaneImage image(points, all, PlaneFrame{}, 2.0);
    const std::vector<StraightRun> runs = straight_runs(image, 0.5);
    const auto lowest = std::find_if(runs.begin(), runs.end(), [](const StraightRun& run) {
      return run.line.along.x() > 0.99 && run.line.origin.y() < 0.2;
    });
    ASSERT_NE(lowest, runs.end());
    const std::optional<BorderFit> fit = fit_border(image, *lowest, 0.0, {});
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->line.at(0.0, 0.0).y(), 0.0, 0.003) << (rows ? "rows" : "random");
    EXPECT_NEAR(fit->line.along.y(), 0.0, radians(0.5));
    EXPECT_GT(fit->shortfall_m, 0.005);
  }
}

/// Borders along u that hold for points of the band 0 < v < `width_m`, in rows of even v.
int borders_of_band(double width_m, double rows_m, double along_m) {
  RandomStream stream(5);
  std::vector<Vector3d> points;
  for (double v = 0.5 * rows_m; v < width_m; v += rows_m)
    for (double u = stream.uniform(0.0, along_m); u < 4.0; u += along_m)
      points.emplace_back(u, v + 0.002 * stream.normal(), 0.0);
  std::vector<std::uint32_t> all(points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  const PlaneImage image(points, all, PlaneFrame{}, 4.0 * width_m);
  int stated = 0;
  for (const StraightRun& run : straight_runs(image, 0.5)) {
    if (std::abs(run.line.along.x()) < 0.99) continue;
    const std::optional<BorderFit> fit = fit_border(image, run, 0.0, {});
    if (fit && fit->sigma_m < 0.006) ++stated;
  }
  return stated;
}

TEST(SegmentBorders, ASingleRowDoesNotTellWhereItsSurfaceEnds) {
  EXPECT_EQ(borders_of_band(0.06, 0.1, 0.05), 0);
  EXPECT_EQ(borders_of_band(0.5, 0.1, 0.05), 0);  // rows too far apart
  EXPECT_GT(borders_of_band(0.5, 0.01, 0.01), 0);
}

TEST(SegmentImage, ContoursGoRoundHolesTheOtherWay) {
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> all;
  for (double u = 0.0; u < 2.0; u += 0.02) {
    for (double v = 0.0; v < 2.0; v += 0.02) {
      if (std::abs(u - 1.0) < 0.4 && std::abs(v - 1.0) < 0.4) continue;
      all.push_back(static_cast<std::uint32_t>(points.size()));
      points.emplace_back(u, v, 0.0);
    }
  }
  const PlaneImage image(points, all, PlaneFrame{}, 3.36);
  const std::vector<Ring> rings = image.contours();
  ASSERT_EQ(rings.size(), 2U);
  EXPECT_NEAR(signed_area(rings[0]), 4.0, 0.4);
  EXPECT_NEAR(signed_area(rings[1]), -0.64, 0.15);
  EXPECT_TRUE(image.covered({0.3, 0.3}));
  EXPECT_FALSE(image.covered({1.0, 1.0}));
}

TEST(SegmentMerge, ABorderBesideACreaseIsTheCrease) {
  DetectedEdge crease;
  crease.segment = {Vector3d(0, 0, 0), Vector3d(2, 0, 0)};
  DetectedEdge border;
  border.kind = EdgeKind::border;
  border.segment = {Vector3d(0.5, 0.008, 0), Vector3d(3, 0.008, 0)};
  const std::vector<DetectedEdge> merged = merged_edges({border, crease}, 0.15, 0.2);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_EQ(merged[0].kind, EdgeKind::crease);
  EXPECT_NEAR(merged[1].segment.length(), 1.0, 1e-9);
}

TEST(SegmentMerge, PiecesOfOneLineAreJoinedAcrossSmallGapsOnly) {
  DetectedEdge first;
  first.segment = {Vector3d(0, 0, 0), Vector3d(1, 0, 0)};
  DetectedEdge second = first;
  second.segment = {Vector3d(1.1, 0.001, 0), Vector3d(2, 0.001, 0)};
  DetectedEdge third = first;
  third.segment = {Vector3d(2.5, 0, 0), Vector3d(3, 0, 0)};
  const std::vector<DetectedEdge> merged = merged_edges({first, second, third}, 0.15, 0.2);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_NEAR(merged[0].segment.length(), 2.0, 1e-3);
  EXPECT_NEAR(merged[1].segment.length(), 0.5, 1e-9);
}

TEST(SegmentMerge, EndsAreDrawnToACorner) {
  DetectedEdge first;
  first.segment = {Vector3d(0.05, 0, 0), Vector3d(1, 0, 0)};
  DetectedEdge second;
  second.segment = {Vector3d(0, 0.03, 0), Vector3d(0, 1, 0)};
  const std::vector<DetectedEdge> merged = merged_edges({first, second}, 0.15, 0.2);
  ASSERT_EQ(merged.size(), 2U);
  for (const DetectedEdge& edge : merged) EXPECT_NEAR(edge.segment.a.norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace limen
