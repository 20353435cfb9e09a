// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limen {
namespace {

Vector2d turned(const Vector2d& v, double angle) {
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
          std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// A row of rooms between two lines parallel to the wing's axis.
struct Row {
  double y0 = 0.0;
  double y1 = 0.0;
  bool corridor = false;
};

/// A wing in its own frame and where that frame lies.
struct Wing {
  Vector2d origin = Vector2d::Zero();
  double angle = 0.0;
  std::vector<double> bays;
  double start_wall = 0.0;  ///< what the rooms keep from x = 0
  double end_wall = 0.0;
  bool main = true;

  [[nodiscard]] Vector2d place(const Vector2d& p) const { return origin + turned(p, angle); }
};

std::vector<Row> rows_of(const PlanOptions& o) {
  std::vector<Row> rows = {{o.outer_wall_m, o.outer_wall_m + o.south_depth_m, false}};
  if (o.corridor_m > 0.0) {
    const double y0 = rows.back().y1 + o.inner_wall_m;
    rows.push_back({y0, y0 + o.corridor_m, true});
  }
  if (o.north_depth_m > 0.0) {
    const double y0 = rows.back().y1 + o.inner_wall_m;
    rows.push_back({y0, y0 + o.north_depth_m, false});
  }
  return rows;
}

double depth_of(const PlanOptions& o) {
  return rows_of(o).back().y1 + o.outer_wall_m;
}

/// Groups of neighbouring bays that form one room each.
std::vector<int> partition(int bays, const PlanOptions& o, RandomStream& random) {
  std::vector<int> groups;
  while (bays > 0) {
    const int wanted = o.regular
                           ? o.bays_per_room
                           : 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(o.bays_per_room)));
    groups.push_back(std::min(bays, wanted));
    bays -= groups.back();
  }
  return groups;
}

/// Cuts a room out of a cell at the joint of two wings; `keep_left` of the line through `joint`.
struct Joint {
  bool exists = false;
  Vector2d at = Vector2d::Zero();
  Vector2d direction = Vector2d::UnitY();  ///< towards the north side
};

Ring without_joint(Ring cell, const Joint& joint, bool main_wing, double half_wall) {
  if (!joint.exists) return cell;
  const Vector2d along = main_wing ? joint.direction : Vector2d(-joint.direction);
  const Vector2d left(-along.y(), along.x());
  return clipped(cell, joint.at + half_wall * left, along);
}

bool wide_enough(const Ring& ring) {
  if (ring.size() < 3) return false;
  double perimeter = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return 2.0 * signed_area(ring) / perimeter > 0.45;
}

class Planner {
 public:
  Planner(const PlanOptions& options, RandomStream& random)
      : o_(options), random_(random), rows_(rows_of(options)), depth_(depth_of(options)) {
    plan_.roof_m = floor_of(o_.storeys) + 0.3;
    set_wings();
  }

  FloorPlan run() {
    for (int storey = 0; storey < o_.storeys; ++storey)
      for (const Wing& wing : wings_) add_storey(wing, storey);
    for (const Wing& wing : wings_) add_axes(wing);
    add_gable_axes();
    return plan_;
  }

 private:
  void set_wings() {
    const double length = sum(o_.main_bays_m);
    Wing main{.bays = o_.main_bays_m, .start_wall = o_.outer_wall_m, .end_wall = o_.outer_wall_m};
    if (o_.turn_rad == 0.0) {
      wings_ = {main};
      plan_.envelope = {{0.0, 0.0}, {length, 0.0}, {length, depth_}, {0.0, depth_}};
      return;
    }
    const double turn = o_.turn_rad;
    const double shift = depth_ * std::tan(0.5 * std::abs(turn));
    // The second wing is rotated about the convex corner of the joint; the concave corner is moved back.
    joint_ = {true, {length, turn > 0.0 ? 0.0 : depth_}, turned(Vector2d::UnitY(), 0.5 * turn)};
    Wing second{.bays = o_.second_bays_m, .end_wall = o_.outer_wall_m, .main = false};
    second.angle = turn;
    second.origin = joint_.at - (turn > 0.0 ? 0.0 : depth_) * turned(Vector2d::UnitY(), turn);
    main.end_wall = 0.0;
    wings_ = {main, second};
    const double end = sum(o_.second_bays_m);
    const Vector2d south = turn > 0.0 ? joint_.at : Vector2d(length - shift, 0.0);
    const Vector2d north = turn > 0.0 ? Vector2d(length - shift, depth_) : joint_.at;
    plan_.envelope = {{0.0, 0.0}, south,        second.place({end, 0.0}), second.place({end, depth_}),
                      north,      {0.0, depth_}};
  }

  void add_storey(const Wing& wing, int storey) {
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const bool stairs = o_.stairwell && wing.main && row + 1 == rows_.size() && row > 0;
      const int bays = static_cast<int>(wing.bays.size());
      // The stairs stand in the first bay on every storey.
      std::vector<int> groups =
          rows_[row].corridor ? std::vector<int>{bays} : partition(bays - stairs, o_, random_);
      if (stairs) groups.insert(groups.begin(), 1);
      add_row(wing, storey, row, groups);
    }
  }

  void add_row(const Wing& wing, int storey, std::size_t row, const std::vector<int>& groups) {
    double x0 = 0.0;
    std::size_t bay = 0;
    for (std::size_t group = 0; group < groups.size(); ++group) {
      double x1 = x0;
      for (int i = 0; i < groups[group]; ++i) x1 += wing.bays[bay++];
      const double half = 0.5 * o_.inner_wall_m;
      const double left = group == 0 ? x0 + wing.start_wall : x0 + half;
      const double right = group + 1 == groups.size() ? x1 - wing.end_wall : x1 - half;
      add_room(wing, storey, {left, rows_[row].y0, right, rows_[row].y1}, use_of(wing, row, group));
      x0 = x1;
    }
  }

  struct Cell {
    double x0, y0, x1, y1;
  };

  [[nodiscard]] RoomUse use_of(const Wing& wing, std::size_t row, std::size_t group) const {
    if (rows_[row].corridor) return RoomUse::corridor;
    const bool stairs = o_.stairwell && wing.main && row + 1 == rows_.size() && row > 0 && group == 0;
    return stairs ? RoomUse::stairs : o_.use;
  }

  void add_room(const Wing& wing, int storey, const Cell& cell, RoomUse use) {
    Ring ring = {wing.place({cell.x0, cell.y0}), wing.place({cell.x1, cell.y0}),
                 wing.place({cell.x1, cell.y1}), wing.place({cell.x0, cell.y1})};
    ring = without_joint(ring, joint_, wing.main, 0.5 * o_.inner_wall_m);
    if (!wide_enough(ring)) return;
    Room room;
    room.outline = ring;
    room.storey = storey;
    room.use = use;
    room.floor_m = floor_of(storey);
    // A hung ceiling here and there: rooms of one storey are not all equally high.
    const double hung =
        o_.regular || use == RoomUse::stairs || random_.uniform() < 0.6 ? 0.0 : random_.uniform(0.1, 0.3);
    room.ceiling_m = room.floor_m + height_of(storey) - o_.slab_m - hung;
    plan_.rooms.push_back(room);
  }

  [[nodiscard]] double height_of(int storey) const {
    const auto i = static_cast<std::size_t>(storey);
    return i < o_.storey_heights_m.size() ? o_.storey_heights_m[i] : o_.storey_height_m;
  }

  [[nodiscard]] double floor_of(int storey) const {
    if (o_.storey_heights_m.empty()) return o_.ground_floor_m + storey * o_.storey_height_m;
    double floor = o_.ground_floor_m;
    for (int below = 0; below < storey; ++below) floor += height_of(below);
    return floor;
  }

  void add_axes(const Wing& wing) {
    double x = 0.0;
    int index = wing.main ? 0 : 100;
    for (const double bay : wing.bays) {
      plan_.axes.push_back({wing.place({x + 0.5 * bay, 0.0}), bay, index});
      plan_.axes.push_back({wing.place({x + 0.5 * bay, depth_}), bay, index});
      x += bay;
      ++index;
    }
  }

  void add_gable_axes() {
    const Wing& last = wings_.back();
    const double end = sum(last.bays);
    for (const Row& row : rows_) {
      const double width = row.y1 - row.y0;
      plan_.axes.push_back({wings_.front().place({0.0, 0.5 * (row.y0 + row.y1)}), width, 200});
      plan_.axes.push_back({last.place({end, 0.5 * (row.y0 + row.y1)}), width, 201});
    }
  }

  const PlanOptions& o_;
  RandomStream& random_;
  std::vector<Row> rows_;
  double depth_;
  std::vector<Wing> wings_;
  Joint joint_;
  FloorPlan plan_;
};

}  // namespace

Vector2d WallFace::normal() const {
  const Vector2d along = (b - a).normalized();
  return {-along.y(), along.x()};
}

PlaneFrame WallFace::frame() const {
  const Vector2d along = (a - b).normalized();
  return {{b.x(), b.y(), low_m}, {along.x(), along.y(), 0.0}, Vector3d::UnitZ()};
}

std::vector<WallFace> FloorPlan::faces() const {
  std::vector<WallFace> faces;
  for (std::size_t room = 0; room < rooms.size(); ++room) {
    const Ring& ring = rooms[room].outline;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d& next = ring[(i + 1) % ring.size()];
      if ((next - ring[i]).norm() < 1e-6) continue;
      faces.push_back({ring[i], next, rooms[room].floor_m, rooms[room].ceiling_m, static_cast<int>(room)});
    }
  }
  for (std::size_t i = 0; i < envelope.size(); ++i)
    faces.push_back({envelope[(i + 1) % envelope.size()], envelope[i], base_m, roof_m, -1});
  return faces;
}

Ring clipped(const Ring& ring, const Vector2d& p, const Vector2d& direction) {
  const Vector2d left(-direction.y(), direction.x());
  Ring kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d& b = ring[(i + 1) % ring.size()];
    const double side_a = left.dot(a - p);
    const double side_b = left.dot(b - p);
    if (side_a >= 0.0) kept.push_back(a);
    if ((side_a < 0.0) != (side_b < 0.0)) kept.push_back(a + (b - a) * (side_a / (side_a - side_b)));
  }
  return kept;
}

FloorPlan make_floor_plan(const PlanOptions& options, RandomStream& random) {
  return Planner(options, random).run();
}

FloorPlan moved(const FloorPlan& plan, const Vector2d& origin, double angle_rad) {
  FloorPlan result = plan;
  const auto move = [&](Vector2d& p) { p = origin + turned(p, angle_rad); };
  for (Room& room : result.rooms) {
    for (Vector2d& p : room.outline) move(p);
    move(room.design_origin);
    room.design_x = turned(room.design_x, angle_rad);
    room.design_y = turned(room.design_y, angle_rad);
  }
  for (PlannedDoor& door : result.doors) move(door.at);
  for (Vector2d& p : result.envelope) move(p);
  for (WindowAxis& axis : result.axes) move(axis.at);
  return result;
}

}  // namespace limen
