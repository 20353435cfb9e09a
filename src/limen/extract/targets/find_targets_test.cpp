// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/targets/find_targets.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/site_targets.h"

namespace limen {
namespace {

const TargetOptions kBothKinds{kSphereRadiusM, kBoardSideM};
const Vector3d kSite(6.0, 0.1, 0.2);

/// A wall 3 m behind the targets.
Mesh target_wall() {
  Mesh mesh;
  mesh.add_polygon({{9, -6, -6}, {9, -6, 6}, {9, 6, 6}, {9, 6, -6}}, surface_of(Element::wall));
  return mesh;
}

/// As seen from a scanner at 0 0 0, by default some 4 mm from point to point at 6 m; about an origin of a
/// national grid.
Scan scan_of_targets(const Mesh& mesh, std::size_t points = 400000) {
  const FieldOfView view{-12.0, 12.0, 24.0};
  const Rigid3 heading{rotation_exp({0, 0, -0.21}), Vector3d::Zero()};
  ScannerOptions scanner;
  scanner.noise_m = 0.002;
  Scan scan = station_scan(
      "wall", sweep(RayCaster(mesh), {}, station_pattern(heading, points, view), scanner, 7), {});
  scan.local_origin = {652000, 6840000, 100};
  return scan;
}

PlaneFrame board_at(const Vector3d& middle, double slant_rad, double roll_rad) {
  const Matrix3d turn = rotation_exp({0, 0, slant_rad}) * rotation_exp({roll_rad, 0, 0});
  return {middle, turn * Vector3d(0, -1, 0), turn * Vector3d(0, 0, 1)};
}

void expect_one(const std::vector<FoundTarget>& found, TargetKind kind, const Vector3d& centre) {
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().kind, kind);
  EXPECT_LT((found.front().centre - centre).norm(), 0.001);
  EXPECT_LT((found.front().centre - centre).norm(), 4.0 * found.front().sigma_m);
  EXPECT_LT(found.front().sigma_m, 0.001);
  EXPECT_GT(found.front().points, 200U);
}

TEST(FindTargets, MeasuresASphereToAMillimetre) {
  Mesh mesh = target_wall();
  add_sphere(mesh, kSite);
  expect_one(find_targets(scan_of_targets(mesh), kBothKinds), TargetKind::sphere, kSite);
}

TEST(FindTargets, MeasuresABoardAtAnySlantToAMillimetre) {
  for (const double slant : {-0.7, 0.0, 0.5}) {
    Mesh mesh = target_wall();
    add_board(mesh, board_at(kSite, slant, 2.0 * slant + 0.3));
    expect_one(find_targets(scan_of_targets(mesh), kBothKinds), TargetKind::board, kSite);
  }
}

TEST(FindTargets, TheBordersOfABoardTellWhereRowsOfPointsAreFarApart) {
  // Rows along the edges, 13 mm from one another: the two edges in the middle alone leave 3.7 mm (1 sigma).
  for (const bool on_a_wall : {false, true}) {
    double squares_m2 = 0.0;
    double stated_m2 = 0.0;
    constexpr int kTrials = 10;
    for (int k = 0; k < kTrials; ++k) {
      const Vector3d site = kSite + Vector3d(0.13, 0.0041, 0.0057) * k;
      Mesh mesh = target_wall();
      if (on_a_wall) {
        const double x = site.x() + 0.001;
        mesh.add_polygon({{x, -2, -2}, {x, -2, 2}, {x, 2, 2}, {x, 2, -2}}, surface_of(Element::wall));
      }
      add_board(mesh, board_at(site, 0.0, 0.0));
      const std::vector<FoundTarget> found = find_targets(scan_of_targets(mesh, 36000), kBothKinds);
      ASSERT_EQ(found.size(), 1U) << on_a_wall << " " << k;
      EXPECT_LT(found.front().points, 600U);
      EXPECT_LT((found.front().centre - site).norm(), 4.0 * found.front().sigma_m);
      squares_m2 += (found.front().centre - site).squaredNorm() / (2.0 * kTrials);
      stated_m2 += found.front().sigma_m * found.front().sigma_m / kTrials;
    }
    EXPECT_LT(std::sqrt(squares_m2), 0.003) << on_a_wall;
    EXPECT_LT(std::sqrt(stated_m2), 0.003) << on_a_wall;
  }
}

TEST(FindTargets, SeesASphereBehindAPostAndABoardByItsColours) {
  Mesh mesh = target_wall();
  add_sphere(mesh, kSite);
  mesh.add_box({{4.0, 0.03, -1.0}, 0.0}, {0.05, 0.05, 3.0}, surface_of(Element::furniture));
  expect_one(find_targets(scan_of_targets(mesh), kBothKinds), TargetKind::sphere, kSite);
  Mesh other = target_wall();
  add_board(other, board_at(kSite, 0.2, 0.1));
  Scan coloured = scan_of_targets(other);
  for (const float light : coloured.intensities)
    coloured.colours.insert(coloured.colours.end(), 3, static_cast<std::uint8_t>(255.0F * light));
  coloured.intensities.clear();
  expect_one(find_targets(coloured, kBothKinds), TargetKind::board, kSite);
}

TEST(FindTargets, LeavesOutWhatIsNoTarget) {
  Mesh mesh = target_wall();
  const double r = kSphereRadiusM;
  add_sphere(mesh, kSite + Vector3d(0, 0.8, 0), 0.88 * r);
  add_sphere(mesh, kSite + Vector3d(0, 0.4, 0), 1.12 * r);
  add_sphere(mesh, {9.045, 0.0, 0.8});  // a shallow lamp on the wall
  std::vector<Vector3d> pipe;
  for (int k = 0; k < 40; ++k) {
    const double turn = k * std::numbers::pi / 20;
    pipe.push_back(kSite + Vector3d(r * std::cos(turn), r * std::sin(turn) - 0.5, -2.0));
  }
  mesh.add_prism(pipe, 4.0, surface_of(Element::furniture));
  add_board(mesh, board_at(kSite + Vector3d(0, 0.7, -0.6), 0.1, 0.0), 0.5 * kBoardSideM);
  add_board(mesh, board_at(kSite + Vector3d(0, 0.0, -0.8), 0.1, 0.2), 1.5 * kBoardSideM);
  for (const FoundTarget& found : find_targets(scan_of_targets(mesh), kBothKinds))
    ADD_FAILURE() << to_string(found.kind) << " at " << found.centre.transpose();
}

TEST(FindTargets, RefusesTilesThatRepeat) {
  for (const double tile_m : {0.5 * kBoardSideM, kBoardSideM}) {
    Mesh mesh;
    for (int a = -6; a < 6; ++a) {
      for (int b = -6; b < 6; ++b) {
        Surface tile = surface_of(Element::wall);
        tile.reflectivity = (a + b) % 2 == 0 ? 0.8 : 0.1;
        const Vector3d at(6.0, 0.03 + a * tile_m, 0.01 + b * tile_m);
        mesh.add_polygon(
            {at, at + Vector3d(0, 0, tile_m), at + Vector3d(0, tile_m, tile_m), at + Vector3d(0, tile_m, 0)},
            tile);
      }
    }
    EXPECT_TRUE(find_targets(scan_of_targets(mesh), kBothKinds).empty()) << tile_m;
  }
}

TEST(FindTargets, GivesTheSameForAnyNumberOfThreadsAndNothingWithoutAScanner) {
  Mesh mesh = target_wall();
  add_sphere(mesh, kSite);
  add_board(mesh, board_at(kSite + Vector3d(0, 0.6, 0), 0.3, 0.2));
  Scan scan = scan_of_targets(mesh);
  set_thread_count(1);
  const std::vector<FoundTarget> one = find_targets(scan, kBothKinds);
  set_thread_count(3);
  const std::vector<FoundTarget> three = find_targets(scan, kBothKinds);
  set_thread_count(0);
  ASSERT_EQ(one.size(), 2U);
  ASSERT_EQ(three.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(one[k].centre, three[k].centre);
    EXPECT_EQ(one[k].sigma_m, three[k].sigma_m);
  }
  scan.centres.clear();
  EXPECT_TRUE(find_targets(scan, kBothKinds).empty());
  EXPECT_THROW(find_targets(scan, {72.5, 0.0}), Error);
}

}  // namespace
}  // namespace limen
