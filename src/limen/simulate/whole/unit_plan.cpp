// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/unit_plan.h"

#include <algorithm>

namespace limen {
namespace {

constexpr int kCorridorDesign = 100;  // designs of no unit
constexpr int kStairsDesign = 200;

/// Where a unit's frame lies in the plan.
struct UnitPlace {
  Vector2d origin = Vector2d::Zero();
  Vector2d x = Vector2d::UnitX();
  Vector2d y = Vector2d::UnitY();

  [[nodiscard]] Vector2d at(const Vector2d& p) const { return origin + p.x() * x + p.y() * y; }
  [[nodiscard]] bool mirrored() const { return x.x() * y.y() - x.y() * y.x() < 0.0; }
};

Ring rectangle(const Vector2d& p, const Vector2d& q) {
  const Vector2d low = p.cwiseMin(q);
  const Vector2d high = p.cwiseMax(q);
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// Puts units side by side and storeys above one another.
class RowPlanner {
 public:
  RowPlanner(const UnitTemplate& unit, const RowOptions& options) : unit_(unit), o_(options) {
    // Beyond the last party line there is the rest of the outer wall.
    rim_ = o_.outer_wall_m - 0.5 * o_.party_wall_m;
    length_ = o_.units * unit_.width_m + o_.stairs_m;
    depth_ = unit_.to_corridor ? 2.0 * unit_.depth_m + o_.corridor_m : unit_.depth_m;
  }

  FloorPlan run() {
    plan_.envelope = {{-rim_, 0.0}, {length_ + rim_, 0.0}, {length_ + rim_, depth_}, {-rim_, depth_}};
    plan_.roof_m = o_.ground_floor_m + o_.storeys * o_.storey_height_m + 0.3;
    for (int storey = 0; storey < o_.storeys; ++storey) add_storey(storey);
    return plan_;
  }

 private:
  void add_storey(int storey) {
    corridors_.clear();
    if (unit_.to_corridor) add_corridors(storey);
    for (int k = 0; k < o_.units; ++k) {
      const bool mirrored = o_.mirror_every_other && k % 2 == 1;
      const double x = k * unit_.width_m;
      UnitPlace place;
      place.origin = {mirrored ? x + unit_.width_m : x, 0.0};
      place.x = {mirrored ? -1.0 : 1.0, 0.0};
      add_unit(place, storey);
      if (!unit_.to_corridor) continue;
      // Across the corridor the unit is turned, not mirrored: its left is where the corridor's user has it.
      UnitPlace across;
      across.origin = {mirrored ? x : x + unit_.width_m, depth_};
      across.x = {mirrored ? 1.0 : -1.0, 0.0};
      across.y = {0.0, -1.0};
      add_unit(across, storey);
    }
  }

  void add_unit(const UnitPlace& place, int storey) {
    const auto first = plan_.rooms.size();
    const int unit = next_unit(storey);
    for (std::size_t i = 0; i < unit_.cells.size(); ++i) add_cell(i, place, storey, unit);
    for (const UnitDoor& door : unit_.doors) {
      const Vector2d at = place.at(door.at);
      const auto room = [&](int i) {
        return i < 0 ? corridor_at(at.x()) : first + static_cast<std::size_t>(i);
      };
      plan_.doors.push_back({{room(door.rooms[0]), room(door.rooms[1])}, at, 0.0});
    }
    if (storey > 0) return;
    for (const UnitWindow& window : unit_.windows)
      plan_.axes.push_back({place.at(window.at), window.bay_m, static_cast<int>(plan_.axes.size() % 100)});
  }

  /// Houses keep their number from storey to storey.
  int next_unit(int storey) {
    if (storey != storey_) house_ = 0;
    storey_ = storey;
    if (unit_.own_stairs) return house_++;
    const int unit = units_;
    units_ += unit_.dwellings;
    return unit;
  }

  void add_cell(std::size_t index, const UnitPlace& place, int storey, int unit) {
    const UnitCell& cell = unit_.cells[index];
    const auto half = [&](bool party, bool outer, bool corridor) {
      if (party) return 0.5 * o_.party_wall_m;
      return outer && !corridor ? o_.outer_wall_m : 0.5 * o_.inner_wall_m;
    };
    const Vector2d low(cell.x0 + half(cell.x0 <= 0.0, false, false),
                       cell.y0 + half(false, cell.y0 <= 0.0, false));
    const Vector2d high(cell.x1 - half(cell.x1 >= unit_.width_m, false, false),
                        cell.y1 - half(false, cell.y1 >= unit_.depth_m, unit_.to_corridor));
    Room room = room_of(rectangle(place.at(low), place.at(high)), storey, cell.use);
    room.design = cell.design >= 0 ? cell.design : static_cast<int>(index);
    room.unit = unit + cell.flat;
    room.mirrored = place.mirrored() != cell.mirrored;
    // A cell that copies another has that one's frame, seen in a mirror.
    const Vector2d corner(cell.mirrored ? high.x() : low.x(), low.y());
    room.design_origin = place.at(corner);
    room.design_x = cell.mirrored ? Vector2d(-place.x) : place.x;
    room.design_y = place.y;
    plan_.rooms.push_back(room);
  }

  [[nodiscard]] Room room_of(const Ring& outline, int storey, RoomUse use) const {
    Room room;
    room.outline = outline;
    room.storey = storey;
    room.use = use;
    room.floor_m = o_.ground_floor_m + storey * o_.storey_height_m;
    room.ceiling_m = room.floor_m + o_.storey_height_m - o_.slab_m;
    room.design_origin = outline[0];
    return room;
  }

  void add_corridors(int storey) {
    const double y0 = unit_.depth_m + 0.5 * o_.inner_wall_m;
    const double y1 = unit_.depth_m + o_.corridor_m - 0.5 * o_.inner_wall_m;
    const double units_end = o_.units * unit_.width_m;
    const double piece = std::max(1, o_.corridor_units) * unit_.width_m;
    for (double x = 0.0; x < units_end - 1e-6; x += piece) {
      const double end = std::min(x + piece, units_end);
      const double left = x + (x == 0.0 ? 0.5 * o_.party_wall_m : 0.5 * o_.inner_wall_m);
      const double right =
          end - (end >= units_end && o_.stairs_m <= 0.0 ? 0.5 * o_.party_wall_m : 0.5 * o_.inner_wall_m);
      Room room = room_of(rectangle({left, y0}, {right, y1}), storey, RoomUse::corridor);
      room.design = kCorridorDesign + static_cast<int>(corridors_.size());
      if (!corridors_.empty())
        plan_.doors.push_back({{corridors_.back(), plan_.rooms.size()}, {x, 0.5 * (y0 + y1)}, 1.3});
      corridors_.push_back(plan_.rooms.size());
      plan_.rooms.push_back(room);
    }
    if (o_.stairs_m > 0.0) add_staircase(storey, units_end, 0.5 * (y0 + y1));
  }

  /// At the corridor's end: the landing is where the corridor meets it.
  void add_staircase(int storey, double x, double y) {
    const double y0 = unit_.depth_m + 0.5 * o_.inner_wall_m;
    Room room = room_of(rectangle({x + 0.5 * o_.inner_wall_m, y0},
                                  {x + o_.stairs_m - 0.5 * o_.party_wall_m, depth_ - o_.outer_wall_m}),
                        storey, RoomUse::stairs);
    room.design = kStairsDesign;
    plan_.doors.push_back({{corridors_.back(), plan_.rooms.size()}, {x, std::min(y, y0 + 0.65)}, 0.0});
    plan_.rooms.push_back(room);
  }

  [[nodiscard]] std::size_t corridor_at(double x) const {
    for (const std::size_t i : corridors_)
      if (x < plan_.rooms[i].outline[1].x()) return i;
    return corridors_.back();
  }

  const UnitTemplate& unit_;
  const RowOptions& o_;
  double rim_ = 0.0;
  double length_ = 0.0;
  double depth_ = 0.0;
  int units_ = 0;
  int house_ = 0;
  int storey_ = 0;
  std::vector<std::size_t> corridors_;
  FloorPlan plan_;
};

}  // namespace

UnitTemplate office_unit(RoomUse use, RandomStream& random) {
  UnitTemplate unit;
  unit.width_m = random.uniform(2.9, 3.9);
  unit.depth_m = random.uniform(4.2, 5.6);
  unit.to_corridor = true;
  unit.cells = {{0.0, 0.0, unit.width_m, unit.depth_m, use}};
  unit.doors = {{{0, -1}, {unit.width_m * random.uniform(0.25, 0.75), unit.depth_m}}};
  const double windows = unit.width_m > 3.5 && random.uniform() < 0.5 ? 2.0 : 1.0;
  for (double k = 0.5; k < windows; ++k)
    unit.windows.push_back({{unit.width_m * k / windows, 0.0}, unit.width_m / windows});
  return unit;
}

UnitTemplate hotel_unit(RandomStream& random) {
  UnitTemplate unit;
  const double w = random.uniform(3.3, 4.0);
  const double room = random.uniform(3.8, 4.6);
  const double bath = random.uniform(1.7, 2.0);
  const double d = room + random.uniform(2.0, 2.4);
  unit.width_m = w;
  unit.depth_m = d;
  unit.to_corridor = true;
  unit.cells = {{0.0, 0.0, w, room, RoomUse::living},
                {bath, room, w, d, RoomUse::empty},
                {0.0, room, bath, d, RoomUse::empty}};
  const double passage = 0.5 * (bath + w);
  unit.doors = {{{0, 1}, {passage, room}}, {{1, 2}, {bath, 0.5 * (room + d)}}, {{1, -1}, {passage, d}}};
  unit.windows = {{{0.5 * w, 0.0}, 0.8 * w}};
  return unit;
}

UnitTemplate flats_unit(RandomStream& random) {
  UnitTemplate unit;
  const double flat = random.uniform(6.6, 8.0);
  const double stairs = random.uniform(2.6, 3.0);
  const double south = random.uniform(4.2, 5.0);
  const double hall = south + random.uniform(1.6, 1.9);
  const double d = hall + random.uniform(4.0, 4.6);
  const double w = 2.0 * flat + stairs;
  const double bedroom = flat * random.uniform(0.44, 0.52);
  const double kitchen = flat * random.uniform(0.48, 0.6);
  const double middle = 0.5 * w;
  unit.width_m = w;
  unit.depth_m = d;
  unit.dwellings = 2;
  const std::vector<UnitCell> left = {{0.0, 0.0, bedroom, south},
                                      {bedroom, 0.0, middle, south},
                                      {0.0, south, flat, hall, RoomUse::corridor},
                                      {0.0, hall, kitchen, d},
                                      {kitchen, hall, flat, d}};
  const std::vector<UnitDoor> doors = {{{2, 0}, {0.6 * bedroom, south}},
                                       {{2, 1}, {0.5 * (bedroom + flat), south}},
                                       {{2, 3}, {0.5 * kitchen, hall}},
                                       {{2, 4}, {0.5 * (kitchen + flat), hall}}};
  unit.windows = {{{0.5 * bedroom, 0.0}, bedroom - 0.5},
                  {{0.67 * bedroom + 0.33 * middle, 0.0}, 2.2},
                  {{0.25 * bedroom + 0.75 * middle, 0.0}, 2.2},
                  {{0.5 * kitchen, d}, kitchen - 0.6},
                  {{0.5 * (kitchen + flat), d}, 1.6}};
  unit.cells = left;
  unit.doors = doors;
  // The other flat is this one in a mirror.
  for (std::size_t i = 0; i < left.size(); ++i) {
    UnitCell cell = left[i];
    std::swap(cell.x0, cell.x1);
    cell.x0 = w - cell.x0;
    cell.x1 = w - cell.x1;
    cell.mirrored = true;
    cell.design = static_cast<int>(i);
    cell.flat = 1;
    unit.cells.push_back(cell);
  }
  for (const UnitDoor& door : doors)
    unit.doors.push_back({{door.rooms[0] + 5, door.rooms[1] + 5}, {w - door.at.x(), door.at.y()}});
  for (std::size_t i = 0, n = unit.windows.size(); i < n; ++i)
    unit.windows.push_back({{w - unit.windows[i].at.x(), unit.windows[i].at.y()}, unit.windows[i].bay_m});
  unit.cells.push_back({flat, south, flat + stairs, d, RoomUse::stairs});
  unit.doors.push_back({{2, 10}, {flat, south + 0.65}});
  unit.doors.push_back({{7, 10}, {flat + stairs, south + 0.65}});
  return unit;
}

UnitTemplate house_unit(RandomStream& random) {
  UnitTemplate unit;
  const double w = random.uniform(5.0, 6.2);
  const double front = random.uniform(3.8, 4.6);
  const double d = front + random.uniform(4.6, 5.4);
  const double hall = random.uniform(2.5, 2.8);
  unit.width_m = w;
  unit.depth_m = d;
  unit.own_stairs = true;
  unit.cells = {{0.0, 0.0, w, front}, {hall, front, w, d}, {0.0, front, hall, d, RoomUse::stairs}};
  unit.doors = {
      {{2, 0}, {0.7 * hall, front}}, {{2, 1}, {hall, front + 0.7}}, {{0, 1}, {0.5 * (hall + w), front}}};
  unit.windows = {{{0.27 * w, 0.0}, 2.0}, {{0.73 * w, 0.0}, 2.0}, {{0.5 * (hall + w), d}, w - hall - 0.6}};
  return unit;
}

FloorPlan make_row_plan(const UnitTemplate& unit, const RowOptions& options) {
  return RowPlanner(unit, options).run();
}

}  // namespace limen
