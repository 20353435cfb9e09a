// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/whole_building.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/simulate/furnishing/furnish_rooms.h"
#include "limen/simulate/recipe_parts.h"
#include "limen/simulate/street.h"
#include "limen/simulate/whole/unit_plan.h"

namespace limen {
namespace {

/// A plan of some size, and how its openings look.
struct Design {
  FloorPlan plan;
  FacadeOptions facade;
  int passes = 3;
};

Vector2d sides_of(const Room& room) {
  const auto [low, high] = box_of(room.outline);
  return high - low;
}

/// One station in a room, more in long ones. What joins rooms comes first: a building of which a part is left
/// out still holds together.
std::vector<StationWish> wishes_of(const FloorPlan& plan, StationPlaces places) {
  constexpr double kLeastArea = 3.3;
  constexpr double kReach = 7.5;
  std::vector<StationWish> joining;
  std::vector<StationWish> others;
  for (std::size_t room = 0; room < plan.rooms.size(); ++room) {
    const Room& r = plan.rooms[room];
    const bool joins = r.use == RoomUse::corridor || r.use == RoomUse::stairs;
    if (!joins && signed_area(r.outline) < kLeastArea) continue;
    const double longer = sides_of(r).maxCoeff();
    const int count = places == StationPlaces::rooms ? 1
                      : r.use == RoomUse::stairs     ? 2
                                                 : std::max(1, static_cast<int>(std::ceil(longer / kReach)));
    // Apart from one another, or they would all stand where most can be seen.
    const double inset = count > 1 ? 0.25 : 0.0;
    for (int i = 0; i < count; ++i)
      (joins ? joining : others).push_back({room, (i + inset) / count, (i + 1.0 - inset) / count});
  }
  joining.insert(joining.end(), others.begin(), others.end());
  return joining;
}

/// One station in every open doorway between rooms that have stations.
void add_doorways(WholeBuilding& building) {
  const auto has_station = [&](int room) {
    return std::any_of(building.wishes.begin(), building.wishes.end(),
                       [&](const StationWish& wish) { return static_cast<int>(wish.room) == room; });
  };
  std::vector<StationWish> doorways;
  for (std::size_t i = 0; i < building.world.openings.size(); ++i) {
    const TrueOpening& door = building.world.openings[i];
    if (door.exterior || door.curtained || door.rooms.size() != 2) continue;
    if (!has_station(door.rooms[0]) || !has_station(door.rooms[1])) continue;
    doorways.push_back({.room = static_cast<std::size_t>(door.rooms[0]), .doorway = static_cast<int>(i)});
  }
  building.wishes.insert(building.wishes.end(), doorways.begin(), doorways.end());
}

FacadeOptions look_of(RandomStream& random) {
  FacadeOptions facade = random_facade(SceneOptions{}, 0.12, random);
  facade.extra_door_share = 0.6;
  return facade;
}

/// Nothing that would tell a unit from its neighbour by design.
FacadeOptions regular_look(RandomStream& random) {
  FacadeOptions facade = look_of(random);
  facade.variation = 0.0;
  facade.blank_share = 0.0;
  facade.entrance = false;
  return facade;
}

RowOptions row_of(int units, int storeys, RandomStream& random) {
  RowOptions row;
  row.units = units;
  row.storeys = storeys;
  row.outer_wall_m = random.uniform(0.3, 0.5);
  row.party_wall_m = random.uniform(0.2, 0.28);
  row.inner_wall_m = random.uniform(0.09, 0.18);
  row.storey_height_m = random.uniform(2.8, 3.3);
  row.slab_m = random.uniform(0.25, 0.35);
  row.ground_floor_m = random.uniform(0.2, 0.9);
  return row;
}

/// Two wings at an angle with a corridor and stairs, every room another one. It grows along its wings.
Design museum_design(int size, RandomStream& random) {
  PlanOptions plan;
  plan.main_bays_m = bays(3 + 2 * size, 2.7, 3.9, random);
  plan.second_bays_m = bays(2 + size, 2.9, 3.9, random);
  plan.turn_rad = radians(random.uniform(20.0, 35.0));
  plan.south_depth_m = random.uniform(4.6, 6.5);
  plan.corridor_m = random.uniform(1.8, 2.6);
  plan.north_depth_m = random.uniform(3.8, 5.2);
  plan.outer_wall_m = random.uniform(0.35, 0.6);
  plan.inner_wall_m = random.uniform(0.14, 0.3);
  plan.storeys = 2;
  plan.storey_height_m = random.uniform(3.5, 4.3);
  plan.slab_m = random.uniform(0.3, 0.45);
  plan.ground_floor_m = random.uniform(0.4, 1.1);
  plan.bays_per_room = 3;
  plan.stairwell = true;
  plan.use = RoomUse::exhibition;
  Design design{make_floor_plan(plan, random), look_of(random), 5};
  design.facade.window_width_m = random.uniform(1.2, 1.8);
  design.facade.window_height_m = random.uniform(1.7, 2.2);
  design.facade.door_width_m = random.uniform(1.1, 1.5);
  design.facade.door_height_m = random.uniform(2.1, 2.5);
  design.facade.extra_door_share = 0.7;
  design.facade.gable_share = 1.0;
  return design;
}

/// Rooms of equal bays on both sides of a corridor.
Design corridor_design(const UnitTemplate& unit, int units, int storeys, RandomStream& random) {
  RowOptions row = row_of(units, storeys, random);
  row.corridor_m = random.uniform(1.8, 2.5);
  row.corridor_units = std::max(3, static_cast<int>(20.0 / unit.width_m));
  if (storeys > 1) row.stairs_m = random.uniform(2.6, 3.0);
  row.mirror_every_other = random.uniform() < 0.5;
  return {make_row_plan(unit, row), regular_look(random), 4};
}

Design equal_bays_design(int size, RandomStream& random) {
  Design design = corridor_design(office_unit(RoomUse::exhibition, random), 3 + size, 1 + size / 3, random);
  design.facade.door_width_m = random.uniform(1.0, 1.3);
  return design;
}

Design office_design(int size, RandomStream& random) {
  const int storeys = std::min(8, 1 + size / 40);
  return corridor_design(office_unit(RoomUse::office, random), 1 + size / storeys, storeys, random);
}

Design hotel_design(int size, RandomStream& random) {
  const int storeys = std::min(6, 1 + size / 5);
  Design design = corridor_design(hotel_unit(random), 2 + size / storeys, storeys, random);
  design.facade.door_width_m = 0.85;
  return design;
}

Design flats_design(int size, RandomStream& random) {
  const int storeys = std::min(8, 2 + (size + 1) / 2);
  const int sections = std::max(1, size - 2);
  const RowOptions row = row_of(sections, storeys, random);
  return {make_row_plan(flats_unit(random), row), regular_look(random), 3};
}

Design terrace_design(int size, RandomStream& random) {
  RowOptions row = row_of(1 + size, 2, random);
  row.mirror_every_other = random.uniform() < 0.5;
  return {make_row_plan(house_unit(random), row), regular_look(random), 3};
}

struct NamedDesign {
  const char* name;
  Design (*make)(int size, RandomStream& random);
  std::size_t stations;  ///< of itself
};

// The place in the list is the building's random stream: new ones go to the end.
constexpr std::array<NamedDesign, 6> kDesigns = {{{"museum", museum_design, 20},
                                                  {"equal_bays", equal_bays_design, 16},
                                                  {"flats", flats_design, 48},
                                                  {"office_floor", office_design, 72},
                                                  {"hotel", hotel_design, 32},
                                                  {"terrace", terrace_design, 36}}};

/// The smallest building of the kind that has room for all stations.
Design design_for(const NamedDesign& kind, std::size_t stations, const WholeBuildingOptions& options,
                  std::uint64_t trial) {
  for (int size = 1;; ++size) {
    // The same stream every time: a larger building is of the same make.
    RandomStream random(options.seed, trial);
    Design design = kind.make(size, random);
    if (wishes_of(design.plan, options.places).size() >= stations || size > 1000) return design;
  }
}

std::string use_of(const Room& room) {
  switch (room.use) {
    case RoomUse::living:
      return "living";
    case RoomUse::office:
      return "office";
    case RoomUse::exhibition:
      return "exhibition";
    case RoomUse::corridor:
      return "corridor";
    case RoomUse::stairs:
      return "stairs";
    default:
      return "other";
  }
}

/// Rooms of one design are alike, stairs only where the flight begins and ends alike; corridors by their
/// length.
std::vector<ProjectRoom> rooms_of(const FloorPlan& plan) {
  int top = 0;
  for (const Room& room : plan.rooms) top = std::max(top, room.storey);
  std::vector<ProjectRoom> rooms;
  for (const Room& room : plan.rooms) {
    ProjectRoom truth{.storey = room.storey, .unit = room.unit, .use = use_of(room)};
    truth.area_m2 = signed_area(room.outline);
    truth.alike = room.design;
    if (room.use == RoomUse::stairs && room.design >= 0)
      truth.alike = 1000 * (room.storey == 0 ? 1 : room.storey == top ? 3 : 2) + room.design;
    truth.mirrored = room.mirrored;
    rooms.push_back(truth);
  }
  for (ProjectRoom& room : rooms) {
    const auto same = std::count_if(rooms.begin(), rooms.end(),
                                    [&](const ProjectRoom& other) { return other.alike == room.alike; });
    if (same == 1) room.alike = -1;
  }
  return rooms;
}

void add_wide_ground(World& world, const Ring& envelope) {
  auto [low, high] = box_of(envelope);
  low -= Vector2d(150.0, 150.0);
  high += Vector2d(150.0, 150.0);
  world.mesh.add_polygon({{low.x(), low.y(), 0.0},
                          {high.x(), low.y(), 0.0},
                          {high.x(), high.y(), 0.0},
                          {low.x(), high.y(), 0.0}},
                         surface_of(Element::ground));
}

/// The street all round, and passes along two façades each.
void add_passes(WholeBuilding& building, const Design& design, int passes, RandomStream& random) {
  const Ring envelope = building.world.buildings[0].plan.envelope;
  FacadeOptions opposite = design.facade;
  opposite.storeys.clear();
  StreetOptions street{.edges = envelope.size(), .opposite = opposite};
  street.path_m = random.uniform(7.0, 9.0);
  street.opposite_m = street.path_m + random.uniform(8.0, 11.0);
  add_street(building.world, 0, street, random);
  for (int pass = 0; pass < passes; ++pass)
    building.passes.push_back(drive_past(envelope, static_cast<std::size_t>(pass) % envelope.size(), 2,
                                         street.path_m, street.antenna_m));
  if (random.uniform() < 0.5) building.head_turns_rad = {radians(35.0), radians(-35.0)};
}

}  // namespace

std::vector<std::string> whole_building_names() {
  std::vector<std::string> names;
  names.reserve(kDesigns.size());
  for (const NamedDesign& design : kDesigns) names.emplace_back(design.name);
  return names;
}

WholeBuilding make_whole_building(const WholeBuildingOptions& options) {
  std::uint64_t trial = 500;
  std::string known;
  for (const NamedDesign& kind : kDesigns) {
    ++trial;
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
    if (options.name != kind.name) continue;
    const std::size_t stations = options.stations > 0 ? options.stations : kind.stations;
    Design design = design_for(kind, stations, options, trial);
    design.facade.open_door_share = options.open_door_share;
    WholeBuilding building;
    building.wishes = wishes_of(design.plan, options.places);
    // Doorways join all rooms: without some of them others would be left alone.
    if (options.places != StationPlaces::doorways)
      building.wishes.resize(std::min(stations, building.wishes.size()));
    RandomStream random(options.seed, trial + 100);
    if (options.as_built) building.world.as_built_seed = mix64(options.seed ^ 0xa5b01dULL);
    add_building(building.world, design.plan, design.facade, random);
    // Only the first building's openings are there by now.
    if (options.places == StationPlaces::doorways) add_doorways(building);
    building.rooms = rooms_of(design.plan);
    const std::vector<bool> alike =
        furnish_rooms(building.world, 0, options.furnishing, mix64(options.seed + trial));
    for (std::size_t room = 0; room < alike.size(); ++room)
      building.rooms[room].furnished_alike = alike[room];
    add_wide_ground(building.world, design.plan.envelope);
    add_passes(building, design, options.passes < 0 ? design.passes : options.passes, random);
    settle_furniture(building.world);
    return building;
  }
  throw Error("no whole building is called '" + options.name + "'", "limen simulate",
              "choose one of: " + known);
}

}  // namespace limen
