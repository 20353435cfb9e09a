// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/features/extract_features.h"

#include <cmath>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/sight/estimate_centre.h"
#include "limen/sight/panorama.h"
#include "limen/sight/voxel_map.h"

namespace limen {
namespace {

Scan room_scan(std::size_t points = 60000) {
  return box_scan(points, -1.05, 1.57);
}

SightQuery at(const Vector3d& x, const Vector3d& normal) {
  SightQuery query;
  query.at = x;
  query.normal = normal;
  query.oriented = true;
  return query;
}

TEST(Panorama, KnowsWhatIsThereFreeAndHidden) {
  const Scan scan = room_scan();
  const ExtractedFeatures extracted = extract_features(scan);
  const Panorama view(scan, extracted.labels, extracted.features, Vector3d::Zero());
  const Sight wall = view.look(at({4.01, 0.5, 0.2}, -Vector3d::UnitX()));
  EXPECT_EQ(wall.kind, SightKind::surface);
  ASSERT_GE(wall.plane, 0);
  EXPECT_NEAR(wall.distance_m, -0.01, 0.002);
  EXPECT_EQ(view.look(at({3.0, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::free);
  EXPECT_EQ(view.look(at({4.5, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::hidden);
  // Below the scanner no ray went.
  EXPECT_EQ(view.look(at({0.1, 0.1, -1.5}, Vector3d::UnitZ())).kind, SightKind::unseen);
}

TEST(Panorama, TheBackOfAWallIsNotItsFront) {
  const Scan scan = room_scan();
  const ExtractedFeatures extracted = extract_features(scan);
  const Panorama view(scan, extracted.labels, extracted.features, Vector3d::Zero());
  EXPECT_NE(view.look(at({4.0, 0.5, 0.2}, Vector3d::UnitX())).kind, SightKind::surface);
  EXPECT_NE(view.look(at({4.0, 0.5, 0.2}, Vector3d::UnitY())).kind, SightKind::surface);
}

TEST(VoxelMap, KnowsSurfacesAndWhatRaysPassed) {
  const Scan scan = room_scan();
  const ExtractedFeatures extracted = extract_features(scan);
  const VoxelMap map(scan, extracted.features);
  EXPECT_EQ(map.look(at({4.01, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::surface);
  EXPECT_EQ(map.look(at({1.5, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::free);
  EXPECT_EQ(map.look(at({9.0, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::unseen);
}

TEST(VoxelMap, WithoutAnOpticalCentreNothingIsFree) {
  Scan scan = room_scan();
  scan.centres.clear();
  const ExtractedFeatures extracted = extract_features(scan);
  const VoxelMap map(scan, extracted.features);
  EXPECT_EQ(map.look(at({1.5, 0.5, 0.2}, -Vector3d::UnitX())).kind, SightKind::unseen);
}

TEST(EstimateCentre, FromTheDensityOnWalls) {
  Scan scan = room_scan(120000);
  scan.centres.clear();
  const Vector3d shift(12.5, -7.25, 140.0);
  for (Vector3d& x : scan.points) x += shift;
  const std::optional<EstimatedCentre> found = estimate_centre(extract_features(scan).features);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((found->centre - shift).norm(), 0.05);
  EXPECT_GT(std::abs(found->up.z()), 0.999);
}

TEST(EstimateCentre, EvenlyThinnedCloudsHaveNone) {
  RandomStream stream(8);
  Scan scan;
  for (int i = 0; i < 60000; ++i) {
    const double u = stream.uniform(-3, 3);
    const double v = stream.uniform(-2, 2);
    const std::uint32_t side = stream.below(6);
    if (side == 0) scan.points.emplace_back(u, v, 0);
    if (side == 1) scan.points.emplace_back(u, v, 3);
    if (side == 2) scan.points.emplace_back(u, -2, 1.5 + 0.7 * v);
    if (side == 3) scan.points.emplace_back(u, 2, 1.5 + 0.7 * v);
    if (side == 4) scan.points.emplace_back(-3, 0.6 * u, 1.5 + 0.7 * v);
    if (side == 5) scan.points.emplace_back(3, 0.6 * u, 1.5 + 0.7 * v);
  }
  EXPECT_FALSE(estimate_centre(extract_features(scan).features).has_value());
}

TEST(ExtractFeatures, ABoxHasSixOrientedWalls) {
  const ExtractedFeatures extracted = extract_features(room_scan(400000));
  ASSERT_EQ(extracted.features.planes.size(), 6U);
  for (const PlanarPolygon& plane : extracted.features.planes) {
    EXPECT_TRUE(plane.oriented);
    EXPECT_GT(plane.plane.signed_distance(Vector3d::Zero()), 0.0);
    EXPECT_LT(plane.rms_m, 0.003);
  }
  double area = 0.0;
  for (const SurfaceSample& sample : extracted.features.samples) area += static_cast<double>(sample.area_m2);
  // The floor is not seen below the scanner.
  EXPECT_NEAR(area, 126.0 - 3.14 * 0.86 * 0.86, 8.0);
}

TEST(ExtractFeatures, DegenerateCloudsHaveNoPlanes) {
  Scan scan;
  EXPECT_TRUE(extract_features(scan).features.planes.empty());
  scan.points = {Vector3d(1, 2, 3)};
  EXPECT_TRUE(extract_features(scan).features.planes.empty());
  scan.points.assign(1000, Vector3d(1, 2, 3));
  EXPECT_TRUE(extract_features(scan).features.planes.empty());
  scan.points.clear();
  for (int i = 0; i < 1000; ++i) scan.points.emplace_back(0.01 * i, 0.02 * i, 0.03 * i);
  EXPECT_TRUE(extract_features(scan).features.planes.empty());
}

TEST(ExtractFeatures, ParallelWallsTenCentimetresApartStayTwo) {
  RandomStream stream(3);
  Scan scan;
  for (int i = 0; i < 40000; ++i) {
    const double x = i % 2 == 0 ? 0.0 : 0.10;
    scan.points.emplace_back(x + 0.003 * stream.normal(), stream.uniform(0, 4), stream.uniform(0, 3));
  }
  const ExtractedFeatures extracted = extract_features(scan);
  ASSERT_EQ(extracted.features.planes.size(), 2U);
  const double gap = std::abs(std::abs(extracted.features.planes[0].plane.offset) -
                              std::abs(extracted.features.planes[1].plane.offset));
  EXPECT_NEAR(gap, 0.10, 0.001);
}

TEST(ExtractFeatures, OneWallBehindAColumnStaysOne) {
  RandomStream stream(4);
  Scan scan;
  for (int i = 0; i < 40000; ++i) {
    const double y = stream.uniform(0, 6);
    if (y > 2.5 && y < 3.3) continue;
    scan.points.emplace_back(0.003 * stream.normal(), y, stream.uniform(0, 3));
  }
  const ExtractedFeatures extracted = extract_features(scan);
  ASSERT_EQ(extracted.features.planes.size(), 1U);
  EXPECT_EQ(extracted.features.planes[0].parts.size(), 2U);
}

TEST(ExtractFeatures, AWindowIsAHole) {
  RandomStream stream(6);
  Scan scan;
  for (int i = 0; i < 60000; ++i) {
    const double y = stream.uniform(0, 5);
    const double z = stream.uniform(0, 3);
    if (y > 1.5 && y < 3.0 && z > 1.0 && z < 2.2) continue;
    scan.points.emplace_back(0.003 * stream.normal(), y, z);
  }
  const ExtractedFeatures extracted = extract_features(scan);
  ASSERT_EQ(extracted.features.planes.size(), 1U);
  ASSERT_EQ(extracted.features.planes[0].parts.size(), 1U);
  ASSERT_EQ(extracted.features.planes[0].parts[0].holes.size(), 1U);
  EXPECT_NEAR(std::abs(signed_area(extracted.features.planes[0].parts[0].holes[0])), 1.5 * 1.2, 0.15);
}

}  // namespace
}  // namespace limen
