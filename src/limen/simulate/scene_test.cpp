// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/simulate/recipes.h"
#include "limen/simulate/stations.h"

namespace limen {
namespace {

SceneOptions small(const std::string& name, std::uint64_t seed) {
  SceneOptions options;
  options.name = name;
  options.seed = seed;
  options.points_indoor = 8000;
  if (name != "room" && name != "symmetric_room" && name != "flat") options.points_outdoor = 16000;
  return options;
}

SceneOptions exact(const std::string& name, std::uint64_t seed) {
  SceneOptions options = small(name, seed);
  options.scanner.noise_m = 0.0;
  options.scanner.angle_jitter_rad = 0.0;
  options.scanner.mixed_pixel_share = 0.0;
  return options;
}

double farthest_from_its_plane(const SimulatedCase& made, std::size_t scan) {
  double farthest = 0.0;
  const ScanTruth& truth = made.truth.scans[scan];
  for (std::size_t i = 0; i < made.scans[scan].size(); ++i) {
    if (truth.plane_of_point[i] < 0) continue;
    const Plane& plane = made.truth.planes[static_cast<std::size_t>(truth.plane_of_point[i])].plane;
    const Vector3d x = truth.local_from_scan * made.scans[scan].points[i];
    farthest = std::max(farthest, std::abs(plane.signed_distance(x)));
  }
  return farthest;
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, ExactPointsLieOnTheTruePlanesUnderTheTruePoses) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SimulatedCase made = simulate(exact(GetParam(), seed));
    for (std::size_t scan = 0; scan < made.scans.size(); ++scan) {
      EXPECT_GT(made.scans[scan].size(), 6000U);
      EXPECT_LT(made.scans[scan].size(), 20000U);
      // Faces that are coplanar within 1 mm share a plane: that millimetre is all there may be. Most points
      // lie on a plane of their own.
      EXPECT_LT(farthest_from_its_plane(made, scan), 1.1e-3) << "seed " << seed << " scan " << scan;
    }
  }
}

TEST_P(EveryScene, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const SimulatedCase one = simulate(small(GetParam(), 5));
  set_thread_count(3);
  const SimulatedCase three = simulate(small(GetParam(), 5));
  set_thread_count(0);
  ASSERT_EQ(one.scans.size(), three.scans.size());
  for (std::size_t scan = 0; scan < one.scans.size(); ++scan) {
    EXPECT_EQ(one.scans[scan].points, three.scans[scan].points);
    EXPECT_EQ(one.scans[scan].intensities, three.scans[scan].intensities);
    EXPECT_EQ(one.truth.scans[scan].plane_of_point, three.truth.scans[scan].plane_of_point);
  }
  for (std::size_t i = 0; i < one.truth.openings.size(); ++i)
    for (std::size_t scan = 0; scan < one.scans.size(); ++scan)
      EXPECT_EQ(one.truth.openings[i].sights[scan].cells, three.truth.openings[i].sights[scan].cells);
}

TEST_P(EveryScene, DiffersFromSeedToSeed) {
  const SimulatedCase a = simulate(small(GetParam(), 1));
  const SimulatedCase b = simulate(small(GetParam(), 3));
  EXPECT_NE(a.truth.planes[0].area_m2, b.truth.planes[0].area_m2);
  EXPECT_GT(
      (a.truth.scans[0].local_from_scan.translation - b.truth.scans[0].local_from_scan.translation).norm(),
      0.01);
}

TEST_P(EveryScene, ScansHoldTogetherAndCountsAgree) {
  const SimulatedCase made = simulate(small(GetParam(), 7));
  std::vector<std::size_t> on_planes(made.scans.size(), 0);
  for (const TruePlane& plane : made.truth.planes) {
    EXPECT_NEAR(plane.plane.normal.norm(), 1.0, 1e-12);
    EXPECT_GT(plane.area_m2, 0.0);
    for (std::size_t scan = 0; scan < made.scans.size(); ++scan) on_planes[scan] += plane.inliers[scan];
  }
  for (std::size_t scan = 0; scan < made.scans.size(); ++scan) {
    EXPECT_NO_THROW(made.scans[scan].check());
    const auto& ids = made.truth.scans[scan].plane_of_point;
    ASSERT_EQ(ids.size(), made.scans[scan].size());
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(ids.begin(), ids.end(), [](int id) { return id >= 0; })),
              on_planes[scan]);
  }
}

TEST_P(EveryScene, ExactPointsOfABuildingAsBuiltLieOnItsPlanesAndBulges) {
  SceneOptions options = exact(GetParam(), 2);
  options.as_built = true;
  const SimulatedCase made = simulate(options);
  double steepest = 0.0;
  for (std::size_t scan = 0; scan < made.scans.size(); ++scan) {
    const ScanTruth& truth = made.truth.scans[scan];
    std::size_t off = 0;
    for (std::size_t i = 0; i < made.scans[scan].size(); ++i) {
      if (truth.plane_of_point[i] < 0) continue;
      const TruePlane& plane = made.truth.planes[static_cast<std::size_t>(truth.plane_of_point[i])];
      const Vector3d x = truth.local_from_scan * made.scans[scan].points[i];
      const double distance = plane.plane.signed_distance(x);
      steepest = std::max(steepest, std::abs(plane.bulge.at(x)));
      // Rays along a wall do not follow its bulge.
      if (std::min(std::abs(distance - plane.bulge.at(x)), std::abs(distance)) > 1e-6) ++off;
    }
    EXPECT_EQ(off, 0U) << "scan " << scan;
  }
  EXPECT_GT(steepest, 2e-4);
  EXPECT_LT(steepest, 6e-3);
}

/// Rays that end on the back of a face have slipped through a crack or started inside a wall.
TEST_P(EveryScene, IsClosedAndStationsStandInTheOpen) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SceneOptions options = small(GetParam(), (seed + 1) / 2);
    options.as_built = seed % 2 == 0;
    const Recipe recipe = make_recipe(options);
    const RayCaster caster(recipe.world.mesh);
    RandomStream random(seed, 99);
    int behind = 0;
    int near = 0;
    const auto stations = place_stations(recipe, caster, random);
    EXPECT_EQ(stations.size(), recipe.station_rooms.size());
    for (const Station& station : stations) {
      const ScanPattern pattern = station_pattern({Matrix3d::Identity(), station.position}, 4000);
      for (std::size_t line = 0; line < pattern.lines; ++line) {
        for (std::size_t i = 0; i < pattern.pulses_per_line; ++i) {
          const RayHit hit = caster.cast(station.position, pattern.pulse(line, i).direction);
          behind += hit.found() && hit.inside ? 1 : 0;
          near += hit.found() && hit.range_m < 0.25 ? 1 : 0;
        }
      }
    }
    EXPECT_LE(behind, 1) << "seed " << seed;
    EXPECT_EQ(near, 0) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(scene_names()),
                         [](const auto& named) { return named.param; });

TEST(Scene, ExactPointsOfABareBoxLieOnItsSixPlanesToANanometre) {
  for (const std::uint64_t seed : {1U, 4U, 5U}) {
    const SimulatedCase made = simulate(exact("symmetric_room", seed));
    ASSERT_EQ(made.truth.planes.size(), 6U);
    for (std::size_t scan = 0; scan < 2; ++scan) EXPECT_LT(farthest_from_its_plane(made, scan), 1e-9);
  }
}

TEST(Scene, ExactPointsOfLargePlanesLieOnThemToANanometre) {
  const SimulatedCase made = simulate(exact("museum", 2));
  for (std::size_t scan = 0; scan < made.scans.size(); ++scan) {
    const ScanTruth& truth = made.truth.scans[scan];
    std::size_t on = 0;
    std::size_t off = 0;
    for (std::size_t i = 0; i < made.scans[scan].size(); ++i) {
      if (truth.plane_of_point[i] < 0) continue;
      const TruePlane& plane = made.truth.planes[static_cast<std::size_t>(truth.plane_of_point[i])];
      if (plane.element != Element::wall && plane.element != Element::floor) continue;
      const double distance = plane.plane.signed_distance(truth.local_from_scan * made.scans[scan].points[i]);
      (std::abs(distance) < 1e-9 ? on : off) += 1;
    }
    EXPECT_GT(on, 2000U);
    EXPECT_LT(static_cast<double>(off), 0.01 * static_cast<double>(on));
  }
}

TEST(Scene, RangeNoiseIsAsAsked) {
  SceneOptions options = small("room", 4);
  options.scanner.noise_m = 0.0;
  const SimulatedCase calm = simulate(options);
  options.scanner.noise_m = 0.003;
  const SimulatedCase noisy = simulate(options);
  ASSERT_EQ(calm.scans[0].size(), noisy.scans[0].size());
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < calm.scans[0].size(); ++i) {
    const double error = noisy.scans[0].points[i].norm() - calm.scans[0].points[i].norm();
    sum += error;
    squares += error * error;
  }
  const auto n = static_cast<double>(calm.scans[0].size());
  EXPECT_NEAR(std::sqrt(squares / n), 0.003, 0.0001);
  EXPECT_NEAR(sum / n, 0.0, 0.0002);
}

TEST(Scene, PosesBetweenScansAgreeWithTheWorldOnTheNationalGrid) {
  const SimulatedCase made = simulate(exact("museum", 3));
  EXPECT_EQ(made.truth.local_origin, Vector3d(1050000.0, 6840000.0, 150.0));
  ASSERT_TRUE(made.truth.scans[2].mobile);
  const Rigid3 target_from_source = true_target_from_source(made.truth, 0, 2);
  const Rigid3 pose = world_from_scan(made.truth, 0);
  EXPECT_LT((target_from_source.translation - pose.translation).norm(), 1e-8);
  const Rigid3 there_and_back = true_target_from_source(made.truth, 2, 0) * target_from_source;
  EXPECT_LT(there_and_back.translation.norm(), 2e-8);
  // Whole metres and dyadic fractions: adding the origin loses nothing.
  const Vector3d local = pose.translation - made.truth.local_origin;
  EXPECT_EQ(local, made.truth.scans[0].local_from_scan.translation);
  // A station's point carried to the grid is on its plane there within a tenth of a micrometre.
  for (std::size_t i = 0; i < made.scans[0].size(); i += 97) {
    const int id = made.truth.scans[0].plane_of_point[i];
    if (id < 0 || made.truth.planes[static_cast<std::size_t>(id)].element != Element::wall) continue;
    const Plane world =
        shifted(made.truth.planes[static_cast<std::size_t>(id)].plane, -made.truth.local_origin);
    EXPECT_LT(std::abs(world.signed_distance(target_from_source * made.scans[0].points[i])), 1e-7);
  }
}

TEST(Scene, MobileScansHaveCentresTimesAndTopology) {
  const SimulatedCase made = simulate(small("regular_facade", 2));
  const Scan& scan = made.scans.back();
  ASSERT_TRUE(scan.mobile());
  ASSERT_TRUE(scan.topology.known());
  EXPECT_TRUE(scan.level);
  int heads = 1;
  for (std::size_t i = 1; i < scan.size(); ++i) {
    const bool later_line = scan.topology.line[i] > scan.topology.line[i - 1];
    EXPECT_TRUE(later_line || scan.topology.index[i] > scan.topology.index[i - 1]);
    // A second head starts the drive anew: once, at most.
    heads += scan.times_s[i] <= scan.times_s[i - 1] ? 1 : 0;
    EXPECT_TRUE(later_line || scan.centres[i] == scan.centres[i - 1]);
  }
  EXPECT_LE(heads, 2);
}

TEST(Scene, DriftMovesPointsAndCentresAlikeByTheAmountAsked) {
  const SimulatedCase still = simulate(small("regular_facade", 2));
  SceneOptions options = small("regular_facade", 2);
  options.drift_m = 0.01;
  const SimulatedCase moved = simulate(options);
  const Scan& a = still.scans.back();
  const Scan& b = moved.scans.back();
  ASSERT_EQ(a.size(), b.size());
  Vector3d mean = Vector3d::Zero();
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3d shift = b.points[i] - a.points[i];
    EXPECT_LT((shift - (b.centres[i] - a.centres[i])).norm(), 1e-9);
    mean += shift / static_cast<double>(a.size());
    largest = std::max(largest, shift.norm());
  }
  EXPECT_GT(largest, 0.005);
  EXPECT_LT(largest, 0.1);
  EXPECT_LT(mean.norm(), 0.5 * largest);
}

TEST(Scene, TwoStationsOfAFlatSeeTheirDoorFromBothSides) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const SimulatedCase made = simulate(small("flat", seed));
    ASSERT_EQ(made.scans.size(), 2U);
    EXPECT_NE(made.truth.scans[0].room, made.truth.scans[1].room);
    const bool both =
        std::any_of(made.truth.openings.begin(), made.truth.openings.end(), [](const TrueOpening& door) {
          return door.kind == "door" && door.sights[0].through > 5 && door.sights[1].through > 5;
        });
    EXPECT_TRUE(both) << "seed " << seed;
  }
}

TEST(Scene, ASymmetricRoomRepeatsItselfUnderItsTurns) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Recipe recipe = make_recipe(small("symmetric_room", seed));
    const Ring& outline = recipe.world.buildings[0].plan.rooms[0].outline;
    const Vector2d middle = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
    const double quarter_turns = seed % 2 == 0 ? 1.0 : 2.0;
    const Matrix3d turn = rotation_exp({0.0, 0.0, quarter_turns * std::acos(0.0)});
    const Vector3d centre(middle.x(), middle.y(), 0.0);
    const Rigid3 turned{turn, centre - turn * centre};
    for (const Surface& surface : recipe.world.mesh.surfaces()) {
      const Plane image = transformed(turned, surface.plane);
      const bool found = std::any_of(recipe.world.mesh.surfaces().begin(), recipe.world.mesh.surfaces().end(),
                                     [&](const Surface& other) {
                                       return other.plane.normal.dot(image.normal) > 1.0 - 1e-12 &&
                                              std::abs(other.plane.offset - image.offset) < 1e-9 &&
                                              std::abs(other.area_m2 - surface.area_m2) < 1e-9;
                                     });
      EXPECT_TRUE(found) << "seed " << seed << " " << to_string(surface.element);
    }
  }
}

TEST(Scene, StationsTurnAnyWayOnlyWhereAsked) {
  SceneOptions options = small("room", 6);
  const SimulatedCase level = simulate(options);
  EXPECT_TRUE(level.scans[0].level);
  EXPECT_NEAR(level.truth.scans[0].local_from_scan.rotation(2, 2), 1.0, 1e-12);
  options.any_rotation = true;
  const SimulatedCase free = simulate(options);
  EXPECT_FALSE(free.scans[0].level);
  EXPECT_LT(free.truth.scans[0].local_from_scan.rotation(2, 2), 0.999);
  EXPECT_NEAR(free.truth.scans[0].local_from_scan.rotation.determinant(), 1.0, 1e-12);
}

TEST(Scene, OffersWhatWasAskedFor) {
  SceneOptions options = small("room", 3);
  options.stations = 4;
  options.points_outdoor = 10000;
  const SimulatedCase made = simulate(options);
  ASSERT_EQ(made.scans.size(), 5U);
  EXPECT_TRUE(made.scans.back().mobile());
  options = small("museum", 3);
  options.curtain_share = 1.0;
  for (const TrueOpening& opening : simulate(options).truth.openings)
    EXPECT_TRUE(opening.curtained || opening.kind == "door");
}

TEST(Scene, AStreetCanBeScannedFromATripod) {
  for (const std::string name : {"museum", "townhouse", "room"}) {
    SceneOptions options = small(name, 3);
    options.outdoor = Outdoor::tripod;
    options.stations = 1;
    options.points_outdoor = 20000;
    const SimulatedCase made = simulate(options);
    ASSERT_EQ(made.scans.size(), 2U) << name;
    EXPECT_FALSE(made.scans.back().mobile());
    EXPECT_EQ(made.truth.scans.back().room, -1);
    ASSERT_EQ(made.truth.shared.size(), 1U) << name << ": both see the window and something through it";
    EXPECT_GT(made.truth.shared[0].m2, 0.1) << name;
    EXPECT_GT(
        (made.truth.scans[0].local_from_scan.translation - made.truth.scans[1].local_from_scan.translation)
            .norm(),
        3.0);
  }
  SceneOptions options = small("symmetric_room", 1);
  options.outdoor = Outdoor::tripod;
  EXPECT_THROW(simulate(options), Error) << "there is no street";
}

TEST(Scene, RefusesWhatItCannotMake) {
  SceneOptions options;
  options.name = "castle";
  EXPECT_THROW(simulate(options), Error);
  options = small("room", 1);
  options.drift_m = -1.0;
  EXPECT_THROW(simulate(options), Error);
  options = small("room", 1);
  options.scanner.noise_m = std::nan("");
  EXPECT_THROW(simulate(options), Error);
}

}  // namespace
}  // namespace limen
