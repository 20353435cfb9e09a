// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/fine_planes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/extract/planes/join_pieces.h"
#include "limen/extract/planes/relief_sheets.h"

namespace limen {
namespace {

constexpr double kNoiseM = 0.003;

/// A street scan that is built point by point; seen from 8 m before the wall y = 0.
struct StreetScan {
  Scan scan;
  RandomStream random{1, 0};

  StreetScan() { scan.level = true; }
  void add(const Vector3d& x) {
    scan.points.push_back(x);
    scan.centres.emplace_back(x.x(), 8.0, 2.0);
  }
  /// A patch of a plane y = `depth`, its points evenly and at random.
  void add_patch(double x0, double x1, double z0, double z1, double depth, int points) {
    for (int i = 0; i < points; ++i)
      add({random.uniform(x0, x1), depth + kNoiseM * random.normal(), random.uniform(z0, z1)});
  }
};

std::vector<std::uint32_t> indices_between(std::size_t begin, std::size_t end) {
  std::vector<std::uint32_t> points;
  for (std::size_t i = begin; i < end; ++i) points.push_back(static_cast<std::uint32_t>(i));
  return points;
}

std::size_t planes_joined(const StreetScan& street, std::size_t first) {
  const Vector3d anchor = Vector3d::Zero();
  std::vector<PlanePiece> pieces;
  pieces.push_back(piece_of(street.scan, indices_between(0, first), anchor));
  pieces.push_back(piece_of(street.scan, indices_between(first, street.scan.size()), anchor));
  return joined_pieces(std::move(pieces), {.noise_m = kNoiseM}).size();
}

TEST(JoinPieces, TwoPartsOfOneWallAreOnePlane) {
  StreetScan street;
  street.add_patch(0.0, 4.0, 0.0, 1.0, 0.0, 2000);
  street.add_patch(6.0, 9.0, 0.0, 1.0, 0.0, 1500);
  EXPECT_EQ(planes_joined(street, 2000), 1U);
}

TEST(JoinPieces, TwoCarsInOneLineAreTwoPlanesThoughATiltedOneComesNearBoth) {
  StreetScan street;
  street.add_patch(0.0, 4.0, 0.0, 1.0, 0.0, 2000);
  street.add_patch(5.5, 9.5, 0.0, 1.0, 0.014, 2000);
  EXPECT_EQ(planes_joined(street, 2000), 2U);
}

TEST(JoinPieces, TheTwoSidesOfASheetAreTwoPlanes) {
  StreetScan street;
  street.add_patch(0.0, 4.0, 0.0, 1.0, 0.0, 2000);
  street.add_patch(0.0, 4.0, 0.0, 1.0, 0.0, 2000);
  for (std::size_t i = 2000; i < 4000; ++i) street.scan.centres[i].y() = -8.0;
  EXPECT_EQ(planes_joined(street, 2000), 2U);
}

/// A wall 12 m x 6 m in which every square metre has an upright strip 6 cm wide, 15 cm behind it, and what
/// leads there.
struct Facade {
  StreetScan street;
  PlaneLabels planes;
  std::size_t wall = 0;
  std::size_t frames = 0;

  Facade(int per_strip, int per_reveal) {
    street.add_patch(0.0, 12.0, 0.0, 6.0, 0.0, 7000);
    wall = street.scan.size();
    for (int k = 0; k < 66; ++k) {
      const double x = 0.5 + k % 11;
      const double z = k / 11 + 0.1;
      street.add_patch(x, x + 0.06, z, z + 0.8, -0.15, per_strip);
    }
    frames = street.scan.size();
    for (int k = 0; k < per_reveal; ++k)
      street.add({std::floor(street.random.uniform(0.0, 11.0)) + 0.56 + kNoiseM * street.random.normal(),
                  street.random.uniform(-0.15, 0.0), street.random.uniform(0.0, 6.0)});
    planes.inlier_threshold_m = 0.01;
    planes.labels.assign(street.scan.size(), -1);
    std::fill_n(planes.labels.begin(), wall, 0);
    PointMoments moments;
    for (std::size_t i = 0; i < wall; ++i) moments.add(street.scan.points[i]);
    planes.fits.push_back(fit_plane(moments));
  }
};

TEST(FinePlanes, TheFramesOfAFacadeAreOnePlaneThoughNoneOfThemHoldsMoreThanARow) {
  const Facade facade(8, 400);
  const PlaneLabels fine = fine_planes(facade.street.scan, facade.planes, {.noise_m = kNoiseM});
  ASSERT_GE(fine.fits.size(), 2U);
  const std::int32_t label = fine.labels[facade.wall];
  ASSERT_GT(label, 0);
  std::size_t frames = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < fine.labels.size(); ++i) {
    if (fine.labels[i] != label) continue;
    ++all;
    if (i >= facade.wall && i < facade.frames) ++frames;
  }
  EXPECT_GT(frames, 9 * (facade.frames - facade.wall) / 10);
  EXPECT_GT(10 * frames, 9 * all);
  const Plane& plane = fine.fits[static_cast<std::size_t>(label)].plane;
  EXPECT_NEAR(std::abs(plane.signed_distance({6.0, -0.15, 3.0})), 0.0, 0.001);
}

TEST(FinePlanes, ACrowdIsNoSheet) {
  Facade facade(0, 0);
  StreetScan& street = facade.street;
  for (int i = 0; i < 6000; ++i)
    street.add({street.random.uniform(0.0, 12.0), street.random.uniform(-0.6, 0.6),
                street.random.uniform(0.0, 6.0)});
  facade.planes.labels.resize(street.scan.size(), -1);
  EXPECT_TRUE(relief_sheets(street.scan, facade.planes, Vector3d::Zero(), {}).empty());
}

TEST(FinePlanes, AStripOfAKnownPlaneJoinsIt) {
  Facade facade(0, 0);
  StreetScan& street = facade.street;
  street.add_patch(12.2, 12.26, 0.0, 6.0, 0.0, 120);
  const std::size_t strip = street.scan.size();
  street.add_patch(12.3, 12.36, 0.0, 6.0, -0.04, 120);
  facade.planes.labels.resize(street.scan.size(), -1);
  const PlaneLabels more = with_strips(street.scan, facade.planes, 0.008);
  EXPECT_GT(
      std::count(more.labels.begin() + 7000, more.labels.begin() + static_cast<std::ptrdiff_t>(strip), 0),
      110);
  EXPECT_EQ(std::count(more.labels.begin() + static_cast<std::ptrdiff_t>(strip), more.labels.end(), 0), 0);
}

}  // namespace
}  // namespace limen
