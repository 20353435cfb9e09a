// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/scan_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

/// A room about a tripod scanner that sees nothing below `lowest_deg`.
Scan station_scan(double lowest_deg, std::size_t points = 60000) {
  return box_scan(points, radians(lowest_deg), 1.5707);
}

Scan room_of_a_flat() {
  SceneOptions options;
  options.name = "room";
  options.points_indoor = 60000;
  return simulate(options).scans.front();
}

/// The first point of every cube of `side_m`.
Scan kept_apart(const Scan& scan, double side_m) {
  std::set<std::array<double, 3>> seen;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    const Vector3d cube = (scan.points[i] / side_m).array().floor();
    if (seen.insert({cube.x(), cube.y(), cube.z()}).second) kept.push_back(i);
  }
  return subset(scan, kept);
}

Rigid3 some_motion(std::uint64_t trial) {
  RandomStream stream(4, trial);
  return {uniform_rotation(stream),
          {stream.uniform(-30, 30), stream.uniform(-30, 30), stream.uniform(-30, 30)}};
}

/// As a file of 32-bit numbers keeps it.
Scan filed(Scan scan) {
  for (Vector3d& x : scan.points) x = x.cast<float>().cast<double>();
  return scan;
}

/// The frame about the points as they lay before `motion`.
ScanFrame before(const ScanFrame& frame, const Rigid3& motion) {
  ScanFrame back = frame;
  back.frame_from_scan = frame.frame_from_scan * motion.rotation;
  back.corner = inverse(motion) * frame.corner;
  back.place.centre = inverse(motion) * frame.place.centre;
  return back;
}

TEST(ScanFrame, IsTheSameHoweverTheScanLies) {
  const Scan scan = room_of_a_flat();
  const ScanFrame given = find_scan_frame(scan, Gravity::automatic);
  ASSERT_TRUE(given.upright);
  for (std::uint64_t trial = 0; trial < 4; ++trial) {
    const Rigid3 motion = some_motion(trial);
    const ScanFrame other = before(find_scan_frame(filed(moved(scan, motion)), Gravity::automatic), motion);
    EXPECT_TRUE(other.upright);
    EXPECT_LT(rotation_angle(other.frame_from_scan * given.frame_from_scan.transpose()), 1e-4);
    EXPECT_LT((other.corner - given.corner).norm(), 1e-3);
  }
}

/// Some scanners see no zenith either: the wider of two blind cones is then not the one below.
TEST(ScanFrame, AScannerThatIsBlindAboveTooIsNotTurnedOver) {
  for (const double highest_deg : {45.0, 55.0, 90.0}) {
    const Scan scan = box_scan(60000, radians(-60.0), radians(std::min(highest_deg, 89.9)));
    const ScanFrame frame = find_scan_frame(scan, Gravity::automatic);
    EXPECT_GT(frame.frame_from_scan(2, 2), 0.99) << highest_deg;
    EXPECT_TRUE(frame.upright) << highest_deg;
  }
}

/// An open sky is no blind cone where nothing tells that the rays started at the assumed place.
TEST(ScanFrame, AnOpenSkyIsNotBelowTheScanner) {
  RandomStream random(9);
  Scan scan;
  for (int k = 0; k < 60000; ++k) {  // a yard, seen everywhere, with screens about it
    const double heading = radians(40.0 * static_cast<double>(random.below(9)) + 5.0);
    const Vector3d away(std::cos(heading), std::sin(heading), 0.0);
    const Vector3d along(-away.y(), away.x(), 0.0);
    const double noise = random.uniform(-0.003, 0.003);
    if (k % 5 == 0) {
      const double range = 8.0 * std::sqrt(random.uniform());
      const double round = random.uniform(0.0, 6.2831);
      scan.points.emplace_back(range * std::cos(round), range * std::sin(round), -1.5 + noise);
    } else {
      scan.points.emplace_back(away * (6.0 + noise) + along * random.uniform(-1.0, 1.0) +
                               Vector3d(0, 0, random.uniform(-1.0, 1.5)));
    }
  }
  scan.centres = {Vector3d(2.0, 0.0, 0.0)};  // it was not there
  scan.centre_source = PlaceSource::assumed;
  EXPECT_GT(find_scan_frame(scan, Gravity::automatic).frame_from_scan(2, 2), 0.99);
}

TEST(ScanFrame, AndItsPointsDoNotDependOnTheirOrder) {
  const Scan scan = room_of_a_flat();
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0U);
  RandomStream stream(3);
  for (auto i = static_cast<std::uint32_t>(order.size()); i > 1; --i)
    std::swap(order[i - 1], order[stream.below(i)]);
  const Scan shuffled = subset(scan, order);
  const Scan first = laid_in(scan, find_scan_frame(scan, Gravity::automatic));
  const Scan second = laid_in(shuffled, find_scan_frame(shuffled, Gravity::automatic));
  ASSERT_EQ(first.size(), second.size());
  EXPECT_TRUE(std::equal(first.points.begin(), first.points.end(), second.points.begin()));
}

TEST(ScanFrame, UpIsOppositeTheBlindCone) {
  const Scan scan = station_scan(-60.0);
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(3.0, 0.2, 0), Vector3d(0.4, -1.2, 2.0)}) {
    const Matrix3d rotation = rotation_exp(turn);
    const ScanFrame frame = find_scan_frame(moved(scan, {rotation, {1, 2, 3}}), Gravity::unknown);
    EXPECT_TRUE(frame.upright);
    const Vector3d up = frame.frame_from_scan.row(2).transpose();
    EXPECT_GT(up.dot(rotation * Vector3d::UnitZ()), std::cos(radians(0.2)));
  }
}

TEST(ScanFrame, IsNotUprightWhereNothingTellsUpFromDown) {
  EXPECT_FALSE(find_scan_frame(moved(station_scan(-90.0), {rotation_exp({0.4, -1.2, 2.0}), {0, 0, 0}}),
                               Gravity::unknown)
                   .upright);
}

TEST(ScanFrame, AUserMayTellThatZIsUp) {
  EXPECT_TRUE(find_scan_frame(station_scan(-90.0), Gravity::up).upright);
}

/// A tripod that does not stand level: up is the walls' and the floor's, not the file's.
TEST(ScanFrame, TakesATiltOutThatTheFileDoesNotKnow) {
  const Rigid3 tilt{rotation_exp({0.08, -0.05, 0.3}), {0, 0, 0}};
  for (const Gravity gravity : {Gravity::automatic, Gravity::up}) {
    const ScanFrame frame = find_scan_frame(moved(station_scan(-60.0), tilt), gravity);
    const Vector3d up = frame.frame_from_scan.row(2).transpose();
    EXPECT_TRUE(frame.upright);
    EXPECT_GT(up.dot(tilt.rotation * Vector3d::UnitZ()), std::cos(radians(0.2)));
  }
}

/// A vehicle's scan: ground 2 m under the path, a façade 6 m beside it.
TEST(ScanFrame, UpOfAVehicleIsTheGroundsNormal) {
  RandomStream stream(7);
  Scan scan;
  for (int i = 0; i < 60000; ++i) {
    const double x = stream.uniform(0.0, 30.0);
    const Vector3d noise(0.0, 0.003 * stream.normal(), 0.003 * stream.normal());
    scan.centres.emplace_back(x, 0.0, 2.0);
    scan.points.push_back(i % 2 == 0 ? Vector3d(x + noise.y(), stream.uniform(-8.0, 6.0), noise.z())
                                     : Vector3d(x, 6.0 + noise.y(), stream.uniform(0.0, 12.0)));
  }
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(1.7, 0.2, 0.5)}) {
    const Matrix3d rotation = rotation_exp(turn);
    const ScanFrame frame = find_scan_frame(moved(scan, {rotation, {0, 0, 0}}), Gravity::unknown);
    EXPECT_TRUE(frame.upright);
    const Vector3d up = frame.frame_from_scan.row(2).transpose();
    EXPECT_GT(up.dot(rotation * Vector3d::UnitZ()), std::cos(radians(0.5)));
  }
}

TEST(ScannerPlace, AClaimThatThePointsBearOutStays) {
  const ScanFrame frame = find_scan_frame(station_scan(-60.0, 150000), Gravity::automatic);
  EXPECT_EQ(frame.place.source, PlaceSource::stated_by_file);
  EXPECT_TRUE(frame.place.confirmed);
  EXPECT_TRUE(frame.place.centre.isZero());
}

/// The points are moved and nobody says so: 0,0,0, inside the room, is not where they were seen from.
TEST(ScannerPlace, AnAssumedPlaceThatThePointsRefuteIsReplaced) {
  Scan scan = moved(station_scan(-60.0, 150000), {rotation_exp({0.1, 0.2, 1.0}), {1.2, -0.9, 0.4}});
  const Vector3d truth = scan.centres.front();
  scan.centres = {Vector3d::Zero()};
  scan.centre_source = PlaceSource::assumed;
  const ScanFrame frame = find_scan_frame(scan, Gravity::automatic);
  EXPECT_EQ(frame.place.source, PlaceSource::estimated);
  ASSERT_TRUE(frame.place.sigma_m.has_value());
  EXPECT_LT((frame.place.centre - truth).norm(), std::max(0.02, 4.0 * *frame.place.sigma_m));
  ASSERT_TRUE(frame.place.refuted.has_value());
  EXPECT_TRUE(frame.place.refuted->isZero());
}

TEST(ScannerPlace, OfADenseScanIsTestedByAFairShareOfItsPoints) {
  SceneOptions options;
  options.name = "room";
  options.points_indoor = 3000000;
  options.stations = 1;
  const Scan scan = simulate(options).scans.front();
  ASSERT_GT(scan.size(), 2000000U);
  const ScannerPlace claimed = find_scan_frame(scan, Gravity::automatic).place;
  EXPECT_TRUE(claimed.confirmed);
  EXPECT_FALSE(claimed.refuted);
  Scan silent = scan;
  silent.centres.clear();
  const ScannerPlace found = find_scan_frame(silent, Gravity::automatic).place;
  EXPECT_EQ(found.source, PlaceSource::estimated);
  ASSERT_TRUE(found.sigma_m);
  EXPECT_LT((found.centre - scan.centres.front()).norm(), 3.0 * *found.sigma_m);
}

/// Too few points for the density on planes: the spread over directions decides.
TEST(ScannerPlace, AFalseClaimOfASparseScanIsDroppedAndATrueOneKept) {
  Scan scan = station_scan(-60.0, 8000);
  scan.centre_source = PlaceSource::assumed;
  const ScanFrame right = find_scan_frame(scan, Gravity::automatic);
  EXPECT_EQ(right.place.source, PlaceSource::assumed);
  EXPECT_FALSE(right.place.refuted.has_value());
  scan.centres = {Vector3d(2.0, 0.8, -0.5)};
  const ScanFrame wrong = find_scan_frame(scan, Gravity::automatic);
  EXPECT_EQ(wrong.place.source, PlaceSource::unknown);
  EXPECT_TRUE(wrong.place.refuted.has_value());
}

/// Seen from its scanner such a cloud is not even either.
TEST(ScannerPlace, AnEvenlyThinnedCloudRefutesNoClaim) {
  Scan scan = kept_apart(station_scan(-60.0, 300000), 0.05);
  scan.centre_source = PlaceSource::assumed;
  const ScanFrame frame = find_scan_frame(scan, Gravity::automatic);
  EXPECT_EQ(frame.place.source, PlaceSource::assumed);
  EXPECT_FALSE(frame.place.refuted.has_value());
}

TEST(ScannerPlace, WhatTheUserStatedStaysAndIsCalledRefuted) {
  Scan scan = station_scan(-60.0, 150000);
  scan.centres = {Vector3d(1.5, 1.0, 0.5)};
  scan.centre_source = PlaceSource::stated_by_user;
  const ScanFrame frame = find_scan_frame(scan, Gravity::automatic);
  EXPECT_EQ(frame.place.source, PlaceSource::stated_by_user);
  EXPECT_EQ(frame.place.centre, Vector3d(1.5, 1.0, 0.5));
  EXPECT_TRUE(frame.place.refuted.has_value());
}

TEST(ScannerPlace, IsUnknownWhereTheCloudWasThinnedEvenly) {
  RandomStream stream(8);
  Scan scan;
  for (int i = 0; i < 60000; ++i) {
    const double u = stream.uniform(-3, 3);
    const double v = stream.uniform(-2, 2);
    const std::uint32_t side = stream.below(6);
    if (side < 2) scan.points.emplace_back(u, v, side == 0 ? 0 : 3);
    if (side == 2 || side == 3) scan.points.emplace_back(u, side == 2 ? -2 : 2, 1.5 + 0.7 * v);
    if (side == 4 || side == 5) scan.points.emplace_back(side == 4 ? -3 : 3, 0.6 * u, 1.5 + 0.7 * v);
  }
  EXPECT_EQ(find_scan_frame(scan, Gravity::automatic).place.source, PlaceSource::unknown);
}

/// Planes, openings and samples of a scan do not depend on how it lies.
TEST(PrepareScan, FindsTheSameHoweverTheScanLies) {
  const Scan scan = room_of_a_flat();
  const PreparedScan given = prepare_scan(scan);
  const Rigid3 motion = some_motion(9);
  const PreparedScan other = prepare_scan(filed(moved(scan, motion)));
  EXPECT_EQ(given.extracted.features.planes.size(), other.extracted.features.planes.size());
  EXPECT_EQ(given.extracted.features.openings.size(), other.extracted.features.openings.size());
  const double samples = static_cast<double>(given.extracted.features.samples.size());
  EXPECT_NEAR(static_cast<double>(other.extracted.features.samples.size()), samples, 0.01 * samples);
}

/// What is reported is in the scan's own coordinates.
TEST(PrepareScan, FeaturesComeBackIntoTheScansOwnFrame) {
  const Rigid3 motion = some_motion(5);
  Scan scan = moved(station_scan(-60.0), motion);
  scan.local_origin = {1000.0, 2000.0, 100.0};
  const Features own = in_own_frame(prepare_scan(scan));
  ASSERT_EQ(own.planes.size(), 6U);
  const Vector3d shift = own.local_origin - scan.local_origin;
  for (const PlanarPolygon& plane : own.planes) {
    std::size_t near = 0;
    for (const Vector3d& x : scan.points)
      near += std::abs(plane.plane.signed_distance(x - shift)) < 0.01 ? 1U : 0U;
    EXPECT_GE(near, plane.inliers);
    EXPECT_TRUE(plane.oriented);
    EXPECT_GT(plane.plane.signed_distance(motion.translation - shift), 0.0);
  }
}

/// Of points that all lie about as far from their middle chance takes all or none.
TEST(FindScanFrame, PointsInFewPlacesHaveNoFrame) {
  for (const int places : {1, 2, 3}) {
    Scan scan;
    for (int k = 0; k < 300000; ++k) scan.points.emplace_back(0.05 * (k % places), 0.0, 0.0);
    EXPECT_NO_THROW((void)find_scan_frame(scan, Gravity::automatic)) << places;
  }
}

}  // namespace
}  // namespace limen
