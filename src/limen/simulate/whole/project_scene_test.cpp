// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/project_scene.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/simulate/whole/building_scanner.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {
namespace {

ProjectSceneOptions small(const std::string& name) {
  ProjectSceneOptions options;
  options.name = name;
  options.seed = 3;
  options.stations = 8;
  options.passes = 1;
  options.points_station = 6000;
  options.points_pass = 20000;
  return options;
}

struct Made {
  std::vector<Scan> scans;
  ProjectTruth truth;
};

Made made(const ProjectSceneOptions& options) {
  Made result;
  result.truth = simulate_project(options, [&](const Scan& scan) { result.scans.push_back(scan); });
  return result;
}

class EveryBuilding : public testing::TestWithParam<std::string> {};

TEST_P(EveryBuilding, IsTheSameForAnyNumberOfThreads) {
  ProjectSceneOptions options = small(GetParam());
  options.styles = true;
  set_thread_count(1);
  const Made one = made(options);
  set_thread_count(3);
  const Made three = made(options);
  set_thread_count(0);
  ASSERT_EQ(one.scans.size(), three.scans.size());
  for (std::size_t i = 0; i < one.scans.size(); ++i) {
    EXPECT_EQ(one.scans[i].points, three.scans[i].points);
    EXPECT_EQ(to_matrix(world_from_scan(one.truth, i)), to_matrix(world_from_scan(three.truth, i)));
  }
  ASSERT_EQ(one.truth.shared.size(), three.truth.shared.size());
  for (std::size_t i = 0; i < one.truth.shared.size(); ++i)
    EXPECT_EQ(one.truth.shared[i].m2, three.truth.shared[i].m2);
}

TEST_P(EveryBuilding, HasAsManyStationsAsAskedAndItsPasses) {
  const Made project = made(small(GetParam()));
  EXPECT_GE(project.scans.size(), 8U);  // one room may be too full
  EXPECT_EQ(project.scans.size(), project.truth.scans.size());
  EXPECT_TRUE(project.truth.scans.back().mobile);
  for (std::size_t i = 0; i < project.scans.size(); ++i) {
    EXPECT_EQ(project.scans[i].size(), project.truth.scans[i].points);
    EXPECT_EQ(project.scans[i].name, project.truth.scans[i].name);
    EXPECT_NO_THROW(project.scans[i].check());
  }
}

/// Neighbours share what they see through open doors: nearly all stations hang together.
TEST_P(EveryBuilding, HoldsTogetherThroughItsDoors) {
  if (GetParam() == "terrace") GTEST_SKIP() << "houses of a terrace meet in the street only";
  ProjectSceneOptions options = small(GetParam());
  options.stations = 18;
  options.passes = 0;
  options.points_station = 20000;
  options.open_door_share = 1.0;
  const ProjectTruth truth = made(options).truth;
  std::vector<std::size_t> group(truth.scans.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
  for (const SharedSurface& pair : truth.shared) {
    if (pair.m2 < 1.0 || truth.scans[pair.b].mobile) continue;
    const std::size_t from = group[pair.b];
    std::replace(group.begin(), group.end(), from, group[pair.a]);
  }
  std::map<std::size_t, std::size_t> sizes;
  for (std::size_t i = 0; i < group.size(); ++i)
    if (!truth.scans[i].mobile) ++sizes[group[i]];
  std::size_t largest = 0;
  for (const auto& [id, size] : sizes) largest = std::max(largest, size);
  EXPECT_GE(largest + 2, truth.scans.size());
}

/// Stations in rooms and doorways, all doors open: no vehicle is needed to join a storey.
TEST_P(EveryBuilding, StationsInDoorwaysJoinAllOfThem) {
  if (GetParam() == "terrace") GTEST_SKIP() << "houses of a terrace meet in the street only";
  ProjectSceneOptions options = small(GetParam());
  options.as_built = true;
  options.places = StationPlaces::doorways;
  options.passes = 0;
  options.points_station = 20000;
  options.open_door_share = 1.0;
  const ProjectTruth truth = made(options).truth;
  EXPECT_GT(truth.scans.size(), 10U) << "eight in rooms, and those in doorways";
  std::vector<std::size_t> group(truth.scans.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
  for (const SharedSurface& pair : truth.shared) {
    if (pair.m2 < 4.0) continue;
    const std::size_t from = group[pair.b];
    std::replace(group.begin(), group.end(), from, group[pair.a]);
  }
  for (std::size_t i = 0; i < group.size(); ++i) EXPECT_EQ(group[i], group[0]) << truth.scans[i].name;
}

TEST(ProjectScene, HasOneStationARoomAndTripodsInTheStreetWhereAsked) {
  ProjectSceneOptions options = small("equal_bays");
  options.as_built = true;
  options.places = StationPlaces::rooms;
  options.passes = 0;
  options.tripods = 5;
  options.points_station = 20000;
  const Made project = made(options);
  std::map<int, int> stations;
  for (const SimulatedScan& scan : project.truth.scans) ++stations[scan.room];
  EXPECT_EQ(stations[-1], 5);
  for (const auto& [room, count] : stations) EXPECT_EQ(count, room < 0 ? 5 : 1) << "room " << room;
  double shared = 0.0;
  for (const SharedSurface& pair : project.truth.shared)
    if (project.truth.scans[pair.a].room < 0 && project.truth.scans[pair.b].room < 0) shared += pair.m2;
  EXPECT_GT(shared, 20.0) << "neighbours in the street see one facade";
}

TEST_P(EveryBuilding, RoomsOfOneDesignAreBuiltAlike) {
  const WholeBuilding building =
      make_whole_building({.name = GetParam(), .seed = 2, .stations = 24, .passes = 0});
  const auto& rooms = building.world.buildings[0].plan.rooms;
  // Corners and doors in the design's own frame.
  const auto in_design = [](const Room& room, const Vector2d& p) {
    const Vector2d off = p - room.design_origin;
    return Vector2d(room.design_x.dot(off), room.design_y.dot(off));
  };
  const auto doorways = [&](std::size_t room) {
    std::vector<double> places;
    for (const TrueOpening& opening : building.world.openings) {
      if (std::find(opening.rooms.begin(), opening.rooms.end(), static_cast<int>(room)) ==
          opening.rooms.end())
        continue;
      const Vector3d middle =
          0.25 * (opening.outer[0] + opening.outer[1] + opening.inner[0] + opening.inner[1]);
      const Vector2d p = in_design(rooms[room], middle.head<2>());
      places.push_back(100.0 * p.x() + p.y() + 10.0 * (middle.z() - rooms[room].floor_m));
    }
    std::sort(places.begin(), places.end());
    return places;
  };
  int pairs = 0;
  for (std::size_t a = 0; a < rooms.size(); ++a) {
    for (std::size_t b = a + 1; b < rooms.size(); ++b) {
      if (building.rooms[a].alike < 0 || building.rooms[a].alike != building.rooms[b].alike) continue;
      if (rooms[a].use == RoomUse::corridor || rooms[a].use == RoomUse::stairs) continue;
      ++pairs;
      EXPECT_NEAR(building.rooms[a].area_m2, building.rooms[b].area_m2, 1e-9);
      const auto first = doorways(a);
      const auto second = doorways(b);
      ASSERT_EQ(first.size(), second.size()) << a << " " << b;
      for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(first[i], second[i], 1e-6) << a << " " << b;
    }
  }
  if (GetParam() == "museum")
    EXPECT_EQ(pairs, 0);
  else
    EXPECT_GT(pairs, 8);
}

INSTANTIATE_TEST_SUITE_P(All, EveryBuilding, testing::ValuesIn(whole_building_names()),
                         [](const auto& named) { return named.param; });

/// Whether a point lies on what a ray from the scanner towards it meets, panes and doorways passed.
bool on_surface(const RayCaster& caster, const Vector3d& from, const Vector3d& x) {
  const double range = (x - from).norm();
  const Vector3d direction = (x - from) / range;
  double begin = 0.0;
  for (int step = 0; step < 12; ++step) {
    const RayHit hit = caster.cast(from, direction, begin);
    if (!hit.found()) return false;
    if (std::abs(hit.range_m - range) < 1e-5) return true;
    begin = hit.range_m + 1e-3;
  }
  return false;
}

TEST(BuildingScanner, PointsMovedByTheTruePoseLieOnTheBuilding) {
  const WholeBuilding building =
      make_whole_building({.name = "flats", .seed = 4, .stations = 10, .passes = 0});
  const Rigid3 local_from_scene{rotation_exp({0.0, 0.0, 0.7}), Vector3d(3.0, -2.0, 1.0)};
  BuildingScanner scanner(building, local_from_scene, Vector3d::Zero());
  ScanStyle style;
  style.points = 4000;
  style.scanner.noise_m = 0.0;
  style.scanner.angle_jitter_rad = 0.0;
  style.scanner.mixed_pixel_share = 0.0;
  style.tilt_rad = radians(2.0);
  style.file_origin = {2.0, 1.0, -0.5};
  for (const bool any : {false, true}) {
    style.any_rotation = any;
    const auto place = survey(building, scanner.caster(), building.wishes[3], 1);
    ASSERT_TRUE(place);
    const ScannedBuilding station = scanner.station("one", *place, style, 5);
    const Rigid3 scene_from_scan = inverse(local_from_scene) * station.truth.local_from_scan;
    EXPECT_LT((scene_from_scan * station.truth.scanner - place->position).norm(), 2e-5);
    std::size_t off = 0;
    for (const Vector3d& point : station.scan.points)
      off += on_surface(scanner.caster(), scene_from_scan * station.truth.scanner, scene_from_scan * point)
                 ? 0U
                 : 1U;
    EXPECT_LE(off, station.scan.size() / 200) << "grazing rays may miss by rounding";
  }
}

TEST(BuildingScanner, SharedSurfaceIsLargeInARoomAndNoneThroughClosedDoors) {
  const WholeBuilding building = make_whole_building(
      {.name = "office_floor", .seed = 5, .stations = 12, .passes = 0, .open_door_share = 0.0});
  BuildingScanner scanner(building, {}, Vector3d::Zero());
  ScanStyle style;
  style.points = 30000;
  std::size_t room = 0;
  while (building.rooms[room].use != "office") ++room;
  double seen = 1e9;
  for (const std::uint64_t place : {1U, 2U})
    seen =
        std::min(seen, scanner.station("in", *survey(building, scanner.caster(), {room}, place), style, place)
                           .truth.surface_m2);
  scanner.station("next", *survey(building, scanner.caster(), {room + 2}, 1), style, 3);
  double same = 0.0;
  double next = 0.0;
  for (const SharedSurface& pair : scanner.shared()) (pair.b == 1 ? same : next) += pair.m2;
  // Floor, ceiling and walls of the room, most of them seen twice.
  EXPECT_GT(same, 2.0 * building.rooms[room].area_m2);
  EXPECT_LE(same, seen + 1e-9);
  EXPECT_LT(next, 0.1 * same) << "only what both see through their windows";
}

TEST(BuildingScanner, AHalfScannedRoomIsHalf) {
  const WholeBuilding building =
      make_whole_building({.name = "hotel", .seed = 6, .stations = 8, .passes = 0});
  BuildingScanner scanner(building, {}, Vector3d::Zero());
  ScanStyle style;
  style.points = 8000;
  style.view.span_deg = 180.0;
  const auto place = survey(building, scanner.caster(), building.wishes.back(), 1);
  ASSERT_TRUE(place);
  const Scan scan = scanner.station("half", *place, style, 2).scan;
  // Seen from the scanner all points lie on one side of an upright plane.
  bool found = false;
  for (int i = 0; i < 720 && !found; ++i) {
    const Vector3d side(std::cos(radians(0.5 * i)), std::sin(radians(0.5 * i)), 0.0);
    found = std::all_of(scan.points.begin(), scan.points.end(),
                        [&](const Vector3d& p) { return side.dot(p) > -0.06; });
  }
  EXPECT_TRUE(found);
}

TEST(People, StandBeforeWhatIsBehindThem) {
  Sweep sweep;
  const Vector3d scanner(0.0, 0.0, 1.5);
  for (int i = 0; i < 400; ++i) {
    const double y = -2.0 + 0.2 * (i % 20);
    const double z = 0.2 * (i / 20);
    sweep.echoes.push_back({.point = {4.0, y, z}, .surface = 7});
  }
  const std::vector<Person> people = {
      {.at = {2.0, 0.0}, .floor_m = 0.0, .height_m = 1.8, .heading_rad = 0.3}};
  RandomStream random(1);
  hide_behind(sweep, scanner, people, 0.0, random);
  int hidden = 0;
  for (const Echo& echo : sweep.echoes) {
    if (echo.surface == 7) {
      EXPECT_EQ(echo.point.x(), 4.0);
      continue;
    }
    ++hidden;
    EXPECT_NEAR(echo.point.x(), 2.0, 0.35);
    EXPECT_LT(std::abs(echo.point.y()), 0.35);
    EXPECT_LT(echo.point.z(), 1.85);
  }
  EXPECT_GT(hidden, 15);
  EXPECT_LT(hidden, 150);
}

TEST(ProjectScene, DriftMovesThePassAndNothingElse) {
  ProjectSceneOptions options = small("terrace");
  options.drift_m = 0.0;
  const Made still = made(options);
  options.drift_m = 0.02;
  const Made moved = made(options);
  EXPECT_EQ(still.scans.front().points, moved.scans.front().points);
  double largest = 0.0;
  for (std::size_t i = 0; i < still.scans.back().size(); ++i)
    largest = std::max(largest, (still.scans.back().points[i] - moved.scans.back().points[i]).norm());
  EXPECT_GT(largest, 0.005);
  EXPECT_LT(largest, 0.2);
}

TEST(ProjectScene, BuildingsGrowWithTheirStations) {
  for (const std::string& name : whole_building_names())
    for (const std::size_t stations : {12U, 60U})
      EXPECT_EQ(make_whole_building({.name = name, .stations = stations, .passes = 0}).wishes.size(),
                stations)
          << name;
}

TEST(ProjectScene, UnknownBuildingsAndBoundsAreRefused) {
  EXPECT_THROW(made(small("castle")), Error);
  ProjectSceneOptions options = small("flats");
  options.stations = 5000;
  EXPECT_THROW(made(options), Error);
}

}  // namespace
}  // namespace limen
