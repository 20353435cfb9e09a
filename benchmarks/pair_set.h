// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// A handful of scans of one building that make pairs of every kind: one room scanned twice, on another day
// with its furniture partly moved, rooms that a door joins, different rooms built alike (look-alike places),
// rooms that have nothing in common.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/progress.h"
#include "limen/model/scan.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/building_scanner.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/survey.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {

/// What two scans have to do with one another.
enum class PairKind : std::uint8_t {
  same_room,   ///< two places in one room
  other_day,   ///< one room, its furniture partly moved in between
  next_room,   ///< rooms that share at least 3 m^2 of seen surface
  look_alike,  ///< different rooms built alike
  other_room,  ///< of the same building, nothing in common
  unclear      ///< neither: a little surface in common, or not counted (days differ)
};

struct PairSetOptions {
  std::string name = "flats";  ///< one of whole_building_names()
  std::uint64_t seed = 1;
  std::size_t points = 100000;  ///< of a station, about
  std::size_t look_alikes = 3;  ///< rooms like the first one
  bool styles = true;           ///< random ones for scans and furniture; else plain ones
  bool as_built = false;        ///< walls, slabs and openings are off the drawing as real ones are
};

struct PairSetScan {
  Scan scan;
  SimulatedScan truth;
  int day = 0;
};

/// Scans of one building, all poses in one world.
struct PairSet {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<PairSetScan> scans;
  std::vector<ProjectRoom> rooms;
  std::vector<SharedSurface> shared;  ///< among the scans of day 0

  [[nodiscard]] PairKind kind_of(std::size_t a, std::size_t b) const;
  [[nodiscard]] Rigid3 target_from_source(std::size_t source, std::size_t target) const;
  /// Look-alike rooms whose furniture is of one layout, placed by hand.
  [[nodiscard]] bool furnished_alike(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool mirrored(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool same_storey(std::size_t a, std::size_t b) const;

 private:
  [[nodiscard]] const ProjectRoom& room_of(std::size_t scan) const;
};

namespace {

constexpr double kJoined = 3.0;  // m^2
constexpr double kNothing = 0.3;

/// One scan that is wanted.
struct Task {
  StationWish wish;
  int day = 0;
  std::uint64_t place = 0;  ///< another number: another place in the room
};

WholeBuilding building_of(const PairSetOptions& options, std::uint64_t day) {
  WholeBuildingOptions building;
  building.name = options.name;
  building.seed = options.seed;
  building.stations = 14;
  building.passes = 0;
  building.as_built = options.as_built;
  if (options.styles) building.furnishing = random_furnishing_style(options.seed);
  building.furnishing.day = day;
  return make_whole_building(building);
}

/// Chooses the rooms of a set.
class Chooser {
 public:
  Chooser(const WholeBuilding& building, RandomStream& random) : building_(building) {
    const auto& rooms = building.world.buildings[0].plan.rooms;
    for (std::size_t room = 0; room < rooms.size(); ++room) {
      const bool joins = rooms[room].use == RoomUse::corridor || rooms[room].use == RoomUse::stairs;
      if (!joins && signed_area(rooms[room].outline) > 7.0) living_.push_back(room);
    }
    for (std::size_t i = living_.size(); i > 1; --i)
      std::swap(living_[i - 1], living_[random.below(static_cast<std::uint32_t>(i))]);
  }

  std::vector<Task> run(std::size_t look_alikes) {
    std::vector<Task> tasks;
    if (living_.empty()) return tasks;
    const std::size_t first =
        *std::max_element(living_.begin(), living_.end(), [&](std::size_t a, std::size_t b) {
          return std::min(look_alikes, look_alikes_of(a)) < std::min(look_alikes, look_alikes_of(b));
        });
    tasks = {{{first}, 0, 0}, {{first}, 0, 1}, {{first}, 1, 2}};
    std::size_t others = 0;
    for (const std::size_t room : living_) {
      const bool alike = are_alike(first, room);
      if (room == first || (alike ? look_alikes == 0 : others > 0)) continue;
      tasks.push_back({{room}, 0, 0});
      if (alike)
        --look_alikes;
      else
        ++others;
    }
    for (const TrueOpening& door : building_.world.openings) {
      const auto room = static_cast<int>(first);
      if (door.exterior || door.curtained || door.rooms.size() != 2) continue;
      if (door.rooms[0] != room && door.rooms[1] != room) continue;
      tasks.push_back(
          {part_near(static_cast<std::size_t>(door.rooms[door.rooms[0] == room ? 1 : 0]), door), 0, 0});
      break;
    }
    return tasks;
  }

 private:
  [[nodiscard]] bool are_alike(std::size_t a, std::size_t b) const {
    return building_.rooms[a].alike >= 0 && building_.rooms[a].alike == building_.rooms[b].alike;
  }
  [[nodiscard]] std::size_t look_alikes_of(std::size_t room) const {
    return static_cast<std::size_t>(std::count_if(living_.begin(), living_.end(), [&](std::size_t other) {
      return other != room && are_alike(room, other);
    }));
  }
  /// The two metres and a half of a long room on either side of a door.
  [[nodiscard]] StationWish part_near(std::size_t room, const TrueOpening& door) const {
    const Ring& ring = building_.world.buildings[0].plan.rooms[room].outline;
    Vector2d low = ring[0];
    Vector2d high = low;
    for (const Vector2d& p : ring) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Index longer = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    const double length = high[longer] - low[longer];
    const double at = (door.outer[0][longer] - low[longer]) / length;
    return {room, std::clamp(at - 2.5 / length, 0.0, 1.0), std::clamp(at + 2.5 / length, 0.0, 1.0)};
  }

  const WholeBuilding& building_;
  std::vector<std::size_t> living_;
};

}  // namespace

inline const char* to_string(PairKind kind) {
  static constexpr std::array<const char*, 6> names = {"same_room", "other_day",  "next_room",
                                                       "twin",      "other_room", "unclear"};
  return names[static_cast<std::size_t>(kind)];
}

inline const ProjectRoom& PairSet::room_of(std::size_t scan) const {
  return rooms[static_cast<std::size_t>(scans[scan].truth.room)];
}

inline PairKind PairSet::kind_of(std::size_t a, std::size_t b) const {
  const bool one_day = scans[a].day == scans[b].day;
  if (scans[a].truth.room == scans[b].truth.room) return one_day ? PairKind::same_room : PairKind::other_day;
  const bool alike = room_of(a).alike >= 0 && room_of(a).alike == room_of(b).alike;
  if (alike) return PairKind::look_alike;
  if (!one_day) return PairKind::unclear;
  double m2 = 0.0;
  for (const SharedSurface& pair : shared)
    if (pair.a == std::min(a, b) && pair.b == std::max(a, b)) m2 = pair.m2;
  if (m2 >= kJoined) return PairKind::next_room;
  return m2 <= kNothing ? PairKind::other_room : PairKind::unclear;
}

inline Rigid3 PairSet::target_from_source(std::size_t source, std::size_t target) const {
  return inverse(scans[target].truth.local_from_scan) * scans[source].truth.local_from_scan;
}

inline bool PairSet::furnished_alike(std::size_t a, std::size_t b) const {
  return room_of(a).furnished_alike && room_of(b).furnished_alike && room_of(a).alike == room_of(b).alike;
}

inline bool PairSet::mirrored(std::size_t a, std::size_t b) const {
  return room_of(a).mirrored != room_of(b).mirrored;
}

inline bool PairSet::same_storey(std::size_t a, std::size_t b) const {
  return room_of(a).storey == room_of(b).storey;
}

/// The same options give the same scans, bit for bit, for any thread count.
inline PairSet simulate_pair_set(const PairSetOptions& options, Monitor& monitor = silent_monitor()) {
  monitor.begin_stage("simulating");
  RandomStream random(options.seed, 3000);
  const WholeBuilding first = building_of(options, 0);
  const std::vector<Task> tasks = Chooser(first, random).run(options.look_alikes);
  PairSet set{.name = options.name, .seed = options.seed, .scans = {}, .rooms = first.rooms, .shared = {}};
  const Rigid3 world_from_scene{any_heading(random), Vector3d::Zero()};
  for (const int day : {0, 1}) {
    const WholeBuilding another = day == 0 ? WholeBuilding{} : building_of(options, 1);
    const WholeBuilding& building = day == 0 ? first : another;
    BuildingScanner scanner(building, world_from_scene, Vector3d::Zero());
    for (const Task& task : tasks) {
      monitor.throw_if_cancelled();
      if (task.day != day) continue;
      const auto place = survey(building, scanner.caster(), task.wish, mix64(options.seed + task.place));
      if (!place) continue;
      const std::uint64_t seed = mix64(options.seed * 999983 + set.scans.size());
      ScanStyle style;
      style.points = options.points;
      if (options.styles) style = random_scan_style(style, seed);
      ScannedBuilding made =
          scanner.station(fmt::format("station_{}", set.scans.size() + 1), *place, style, seed);
      set.scans.push_back({std::move(made.scan), std::move(made.truth), day});
    }
    // Those of the first day come first: their numbers are the scanner's.
    if (day == 0) set.shared = scanner.shared();
  }
  return set;
}

}  // namespace limen
