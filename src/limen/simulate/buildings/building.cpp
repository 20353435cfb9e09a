// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/building.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/angles.h"
#include "limen/simulate/buildings/shell.h"

namespace limen {
namespace {

/// Two faces that stand back to back, or nothing.
bool back_to_back(const WallFace& inner, const WallFace& outer, WallPair& pair) {
  const Vector2d normal = outer.normal();
  if (normal.dot(inner.normal()) > -1.0 + 1e-9) return false;
  pair.thickness_m = normal.dot(outer.a - inner.a);
  if (pair.thickness_m < 0.03 || pair.thickness_m > 0.9) return false;
  const Vector2d along = (outer.a - outer.b).normalized();
  const double s0 = along.dot(inner.a - outer.b);
  const double s1 = along.dot(inner.b - outer.b);
  pair.begin_m = std::max(0.0, std::min(s0, s1));
  pair.end_m = std::min(outer.length(), std::max(s0, s1));
  return std::min(outer.high_m, inner.high_m) - std::max(outer.low_m, inner.low_m) > 1.8;
}

/// Puts one plan's walls and openings into the world, step by step.
class Builder {
 public:
  Builder(World& world, const FloorPlan& plan, const FacadeOptions& options, RandomStream& random)
      : world_(world),
        plan_(plan),
        o_(options),
        random_(random),
        faces_(plan.faces()),
        holes_(faces_.size()),
        spandrels_(faces_.size()) {
    building_.plan = plan;
    building_.occupied.resize(plan.rooms.size());
    for (const Building& other : world.buildings)
      building_.room_offset += static_cast<int>(other.plan.rooms.size());
    pairs_ = wall_pairs(plan, faces_, 0.8);
    if (world.as_built_seed) build_off_the_drawing(mix64(*world.as_built_seed + world.buildings.size()));
  }

  std::size_t run() {
    choose_bay_variations();
    add_windows();
    if (!plan_.doors.empty())
      add_planned_doors();
    else if (o_.interior_doors)
      add_doors();
    ShellPlan shell{plan_, faces_, holes_, spandrels_, std::nullopt};
    if (as_built_) shell.built.emplace(ShellAsBuilt{*as_built_, built_holes_});
    add_shell(world_.mesh, shell, o_.ornament_share, random_);
    for (std::size_t room = 0; room < plan_.rooms.size(); ++room)
      if (stairs_rise(plan_, room)) building_.occupied[room].push_back({stairs_area(plan_.rooms[room]), 0.0});
    world_.buildings.push_back(std::move(building_));
    return world_.buildings.size() - 1;
  }

 private:
  struct BayStyle {
    double width = 1.0, height = 1.0, sill = 0.0, shift = 0.0;
    bool blank = false;
  };

  void build_off_the_drawing(std::uint64_t seed) {
    std::vector<std::array<std::size_t, 2>> walls;
    for (const WallPair& pair : wall_pairs(plan_, faces_, 0.2))
      if (faces_[pair.outer].room >= 0) walls.push_back({pair.inner, pair.outer});
    as_built_.emplace(plan_, faces_, walls, seed);
    built_holes_.resize(faces_.size());
    for (std::size_t room = 0; room < plan_.rooms.size(); ++room)
      building_.built.push_back({as_built_->room(room).low, as_built_->in_room(room)});
  }

  /// Windows above one another share a bay's style, as they do on real façades.
  void choose_bay_variations() {
    for (std::size_t i = 0; i < plan_.axes.size(); ++i) {
      BayStyle style;
      style.width += o_.variation * random_.uniform(-1.0, 1.0);
      style.height += o_.variation * random_.uniform(-1.0, 0.6);
      style.sill = o_.variation * random_.uniform(-0.5, 0.8);
      style.shift = o_.variation * random_.uniform(-0.5, 0.5);
      const bool gable = plan_.axes[i].bay >= 200;
      style.blank = random_.uniform() < (gable ? 1.0 - o_.gable_share : o_.blank_share);
      bays_.push_back(style);
    }
    entrance_axis_ = o_.entrance && !plan_.axes.empty()
                         ? static_cast<int>(random_.below(static_cast<std::uint32_t>(plan_.axes.size())))
                         : -1;
  }

  void add_windows() {
    for (std::size_t axis = 0; axis < plan_.axes.size(); ++axis) {
      for (const WallPair& pair : pairs_) {
        if (faces_[pair.outer].room >= 0) continue;
        const PlaneFrame frame = faces_[pair.outer].frame();
        const Vector3d at(plan_.axes[axis].at.x(), plan_.axes[axis].at.y(), 0.0);
        if (std::abs(frame.u.cross(Vector3d::UnitZ()).dot(at - frame.origin)) > 1e-6) continue;
        add_window(axis, pair, frame.u.dot(at - frame.origin));
      }
    }
  }

  void add_window(std::size_t axis, const WallPair& pair, double u) {
    const BayStyle& style = bays_[axis];
    const Room& room = plan_.rooms[static_cast<std::size_t>(faces_[pair.inner].room)];
    const bool door = static_cast<int>(axis) == entrance_axis_ && room.storey == 0;
    if (style.blank && !door) return;
    OpeningShape shape;
    shape.kind = door ? OpeningKind::closed_door : OpeningKind::window;
    const StoreyLook look = look_of(room.storey);
    shape.width_m =
        door ? 1.1 : std::min(o_.window_width_m * style.width * look.width, plan_.axes[axis].bay_m - 0.5);
    const double sill = door ? 0.0 : std::max(0.08, o_.sill_m + style.sill + look.sill_m);
    const double top_room = room.ceiling_m - room.floor_m - 0.12;
    shape.height_m =
        std::min(door ? 2.1 : o_.window_height_m * style.height * look.height, top_room - sill - o_.splay_m);
    u += door ? 0.0 : style.shift;
    // A partition or an end of the façade may stand too near: the window is narrowed, or left out.
    const double margin = o_.splay_m + 0.3;
    const double left = std::max(u - 0.5 * shape.width_m, pair.begin_m + margin);
    const double right = std::min(u + 0.5 * shape.width_m, pair.end_m - margin);
    if (right - left < 0.5 || shape.height_m < 0.4) return;
    shape.width_m = right - left;
    if (!door) set_head(shape, look);
    shape.splay_m = door || shape.head != HeadForm::rectangular ? 0.0 : o_.splay_m;
    shape.frame_depth_m = std::min(o_.frame_depth_m, pair.thickness_m - 0.08);
    shape.bar_m = o_.bar_m;
    shape.mullions = shape.width_m < 0.7 ? 0 : o_.mullions;
    shape.transoms = shape.height_m < 1.2 ? 0 : o_.transoms;
    if (!door && random_.uniform() < o_.curtain_share)
      shape.cover = random_.uniform() < 0.65 ? Cover::curtain : Cover::blind;
    place(shape, pair, {left, room.floor_m + sill});
  }

  [[nodiscard]] StoreyLook look_of(int storey) const {
    if (o_.storeys.empty()) return {};
    return o_.storeys[std::min(static_cast<std::size_t>(storey), o_.storeys.size() - 1)];
  }

  /// An arch must leave jambs below it; a round window is as high as it is wide.
  static void set_head(OpeningShape& shape, const StoreyLook& look) {
    shape.head = look.head;
    shape.rise_m = look.rise * shape.width_m;
    const double rise = look.head == HeadForm::semicircle ? 0.5 * shape.width_m : shape.rise_m;
    if (look.head == HeadForm::round)
      shape.height_m = std::min(shape.height_m, shape.width_m);
    else if (rise + 0.3 > shape.height_m)
      shape.head = HeadForm::rectangular;
  }

  /// Doors: a random spanning tree over the rooms of each storey, corridors first, and some more.
  void add_doors() {
    std::vector<std::pair<double, const WallPair*>> candidates;
    for (const WallPair& pair : pairs_) {
      if (faces_[pair.outer].room < 0 || pair.end_m - pair.begin_m < o_.door_width_m + 0.5) continue;
      const bool corridor =
          use_of(pair.inner) == RoomUse::corridor || use_of(pair.outer) == RoomUse::corridor;
      candidates.emplace_back(random_.uniform() + (corridor ? 0.0 : 1.0), &pair);
    }
    std::sort(candidates.begin(), candidates.end());
    std::vector<int> group(plan_.rooms.size());
    std::iota(group.begin(), group.end(), 0);
    for (const auto& [weight, pair] : candidates) {
      const int a = group[static_cast<std::size_t>(faces_[pair->inner].room)];
      const int b = group[static_cast<std::size_t>(faces_[pair->outer].room)];
      const bool extra = random_.uniform() < o_.extra_door_share;
      if (a == b && (weight < 1.0 || !extra)) continue;
      std::replace(group.begin(), group.end(), b, a);
      add_door(*pair);
    }
  }

  /// Doors where the plan wants them, each in the wall that is nearest of those the two rooms share.
  void add_planned_doors() {
    for (const PlannedDoor& door : plan_.doors) {
      const WallPair* best = nullptr;
      double nearest = 1.0;
      for (const WallPair& pair : pairs_) {
        const std::array<int, 2> rooms = {faces_[pair.inner].room, faces_[pair.outer].room};
        const auto a = static_cast<int>(door.rooms[0]);
        const auto b = static_cast<int>(door.rooms[1]);
        if (rooms != std::array<int, 2>{a, b} && rooms != std::array<int, 2>{b, a}) continue;
        const double off = std::abs(faces_[pair.outer].normal().dot(door.at - faces_[pair.outer].a));
        if (off >= nearest) continue;
        nearest = off;
        best = &pair;
      }
      if (best != nullptr) add_planned_door(door, *best);
    }
  }

  void add_planned_door(const PlannedDoor& door, WallPair pair) {
    // The leaf swings into pair.inner: a room, not the passage before it.
    const auto passage = [&](std::size_t face) {
      return use_of(face) == RoomUse::corridor || use_of(face) == RoomUse::stairs;
    };
    if (passage(pair.inner) && !passage(pair.outer)) {
      std::swap(pair.inner, pair.outer);
      back_to_back(faces_[pair.inner], faces_[pair.outer], pair);
    }
    const WallFace& outer = faces_[pair.outer];
    const double width = door.width_m > 0.0 ? door.width_m : o_.door_width_m;
    const double middle = (outer.a - outer.b).normalized().dot(door.at - outer.b);
    const double low = pair.begin_m + 0.05;
    const double high = pair.end_m - 0.05 - width;
    if (high < low) return;
    OpeningShape shape = door_leaf(pair, width);
    const double left = std::clamp(middle - 0.5 * width, low, high);
    shape.hinge_left = left - pair.begin_m < pair.end_m - left - width;
    place(shape, pair, {left, faces_[pair.inner].low_m});
  }

  [[nodiscard]] OpeningShape door_leaf(const WallPair& pair, double width) {
    OpeningShape shape;
    shape.kind = random_.uniform() < o_.open_door_share ? OpeningKind::open_door : OpeningKind::closed_door;
    shape.width_m = width;
    const WallFace& inner = faces_[pair.inner];
    shape.height_m =
        std::min(o_.door_height_m, std::min(inner.high_m, faces_[pair.outer].high_m) - inner.low_m - 0.1);
    shape.leaf_angle_rad = radians(random_.uniform(80.0, 115.0));
    return shape;
  }

  void add_door(const WallPair& pair) {
    OpeningShape shape = door_leaf(pair, o_.door_width_m);
    random_.uniform();  // once drew the side of the hinge: the numbers after it stay what they were
    const double left = random_.uniform(pair.begin_m + 0.2, pair.end_m - 0.2 - shape.width_m);
    // The leaf lies against the nearer end of the wall.
    shape.hinge_left = left - pair.begin_m < pair.end_m - left - shape.width_m;
    place(shape, pair, {left, faces_[pair.inner].low_m});
  }

  /// Cuts the opening into both faces, adds its parts and its truth. `at`: lower left on the outer face.
  void place(OpeningShape shape, const WallPair& pair, const Vector2d& at) {
    const WallFace& outer = faces_[pair.outer];
    const PlaneFrame frame = outer.frame();
    shape.id = static_cast<int>(world_.openings.size());
    shape.thickness_m = pair.thickness_m;
    shape.outer = frame;
    shape.outer.origin = frame.to_space({at.x(), at.y() - outer.low_m});
    cut(pair.outer, shape.outer_corners(), shape);
    cut(pair.inner, shape.inner_corners(), shape);
    if (as_built_) {
      const BuiltOpening built = as_built_->opening(shape, pair.inner, pair.outer);
      built_holes_[pair.outer].push_back(built.outer_outline(shape));
      built_holes_[pair.inner].push_back(built.inner_outline(shape));
      add_opening_parts(world_.mesh, shape, &built, random_);
      record(shape, pair);
      correct(world_.openings.back(), shape, built);
    } else {
      add_opening_parts(world_.mesh, shape, nullptr, random_);
      record(shape, pair);
    }
    keep_clear(shape, pair);
  }

  static void correct(TrueOpening& opening, const OpeningShape& shape, const BuiltOpening& built) {
    opening.outer = built.outer_corners(shape);
    opening.inner = built.inner_corners(shape);
    opening.outer_outline = built.outer_outline(shape);
    opening.inner_outline = built.inner_outline(shape);
    opening.normal = built.outer.normal;
    const Vector3d middle =
        0.25 * (opening.inner[0] + opening.inner[1] + opening.inner[2] + opening.inner[3]);
    opening.thickness_m = -built.outer.signed_distance(middle);
  }

  void cut(std::size_t face, const std::array<Vector3d, 4>& corners, const OpeningShape& shape) {
    const PlaneFrame frame = faces_[face].frame();
    const Vector2d p = frame.to_plane(corners[0]);
    const Vector2d q = frame.to_plane(corners[2]);
    const PanelRect hole{std::min(p.x(), q.x()), p.y(), std::max(p.x(), q.x()), q.y()};
    holes_[face].push_back(hole);
    // Curved outlines are the same from both sides.
    for (PanelTriangle triangle : spandrels(shape.outline(), {shape.width_m, shape.height_m})) {
      for (Vector2d& x : triangle) x += Vector2d(hole.u0, hole.v0);
      spandrels_[face].push_back(triangle);
    }
  }

  void record(const OpeningShape& shape, const WallPair& pair) {
    TrueOpening opening;
    opening.kind = shape.kind == OpeningKind::window ? "window" : "door";
    opening.outer = shape.outer_corners();
    opening.inner = shape.inner_corners();
    opening.head = to_string(shape.head);
    opening.outer_outline = shape.outer_outline();
    opening.inner_outline = shape.inner_outline();
    opening.normal = shape.outer.u.cross(shape.outer.v);
    opening.thickness_m = shape.thickness_m;
    opening.exterior = faces_[pair.outer].room < 0;
    opening.glazed = shape.kind == OpeningKind::window;
    opening.curtained = shape.cover != Cover::none || shape.kind == OpeningKind::closed_door;
    opening.rooms = {building_.room_offset + faces_[pair.inner].room};
    if (!opening.exterior) opening.rooms.push_back(building_.room_offset + faces_[pair.outer].room);
    world_.openings.push_back(opening);
  }

  /// What furniture must leave free before and behind the opening.
  void keep_clear(const OpeningShape& shape, const WallPair& pair) {
    const bool door = shape.kind != OpeningKind::window;
    const double reach = door ? shape.width_m + 0.3 : 0.5;
    const Vector2d along(shape.outer.u.x(), shape.outer.u.y());
    const auto block = [&](int room, double depth) {
      if (room < 0) return;
      const Vector3d middle = shape.at(0.5 * shape.width_m, 0.0, depth);
      const double floor = plan_.rooms[static_cast<std::size_t>(room)].floor_m;
      building_.occupied[static_cast<std::size_t>(room)].push_back(
          {rectangle_ring({middle.x(), middle.y()}, along, {shape.width_m + 0.2, reach}),
           door ? 0.0 : middle.z() - floor - 0.05});
    };
    block(faces_[pair.inner].room, shape.thickness_m + 0.5 * reach);
    block(faces_[pair.outer].room, -0.5 * reach);
    // An open leaf lies along the hinge side.
    if (!door) return;
    const Vector3d hinge =
        shape.at(shape.hinge_left ? -0.15 : shape.width_m + 0.15, 0.0, shape.thickness_m + 0.5 * reach);
    building_.occupied[static_cast<std::size_t>(faces_[pair.inner].room)].push_back(
        {rectangle_ring({hinge.x(), hinge.y()}, along, {0.7, reach}), 0.0});
  }

  [[nodiscard]] RoomUse use_of(std::size_t face) const {
    return plan_.rooms[static_cast<std::size_t>(faces_[face].room)].use;
  }

  World& world_;
  const FloorPlan& plan_;
  const FacadeOptions& o_;
  RandomStream& random_;
  std::vector<WallFace> faces_;
  std::vector<std::vector<PanelRect>> holes_;
  std::vector<std::vector<PanelTriangle>> spandrels_;
  std::vector<WallPair> pairs_;
  std::vector<BayStyle> bays_;
  int entrance_axis_ = -1;
  std::optional<AsBuilt> as_built_;
  std::vector<std::vector<std::vector<Vector3d>>> built_holes_;  ///< per face, in space
  Building building_;
};

}  // namespace

std::vector<WallPair> wall_pairs(const FloorPlan& plan, const std::vector<WallFace>& faces,
                                 double shortest_m) {
  std::vector<WallPair> pairs;
  for (std::size_t inner = 0; inner < faces.size(); ++inner) {
    if (faces[inner].room < 0) continue;
    const int storey = plan.rooms[static_cast<std::size_t>(faces[inner].room)].storey;
    for (std::size_t outer = inner + 1; outer < faces.size(); ++outer) {
      const int other = faces[outer].room;
      if (other == faces[inner].room) continue;
      if (other >= 0 && plan.rooms[static_cast<std::size_t>(other)].storey != storey) continue;
      WallPair pair{.inner = inner, .outer = outer};
      if (back_to_back(faces[inner], faces[outer], pair) && pair.end_m - pair.begin_m >= shortest_m)
        pairs.push_back(pair);
    }
  }
  return pairs;
}

double Building::floor_height(std::size_t room, const Vector2d& at) const {
  if (built.empty()) return plan.rooms[room].floor_m;
  const Plane& floor = built[room].floor;
  return (floor.offset - floor.normal.head<2>().dot(at)) / floor.normal.z();
}

void remember_furniture(World& world, std::size_t building, std::size_t room, const MeshMark& begin) {
  if (world.as_built_seed) world.buildings[building].furniture.push_back({room, begin, world.mesh.mark()});
}

void settle_furniture(World& world) {
  for (Building& building : world.buildings) {
    for (const FurnitureRange& range : building.furniture)
      world.mesh.map(range.begin, range.end, building.built[range.room].carry);
    building.furniture.clear();
  }
}

Ring rectangle_ring(const Vector2d& centre, const Vector2d& along, const Vector2d& size) {
  const Vector2d x = 0.5 * size.x() * along;
  const Vector2d y = 0.5 * size.y() * Vector2d(-along.y(), along.x());
  return {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
}

std::size_t add_building(World& world, const FloorPlan& plan, const FacadeOptions& options,
                         RandomStream& random) {
  return Builder(world, plan, options, random).run();
}

}  // namespace limen
