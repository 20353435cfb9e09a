// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/building.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/angles.h"

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
        holes_(faces_.size()) {
    building_.plan = plan;
    building_.occupied.resize(plan.rooms.size());
    for (const Building& other : world.buildings)
      building_.room_offset += static_cast<int>(other.plan.rooms.size());
    pairs_ = wall_pairs(plan, faces_, 0.8);
  }

  std::size_t run() {
    choose_bay_variations();
    add_windows();
    if (o_.interior_doors) add_doors();
    add_walls();
    add_slabs();
    if (plan_.stair_bottom >= 0) add_stairs();
    add_outside();
    world_.buildings.push_back(std::move(building_));
    return world_.buildings.size() - 1;
  }

 private:
  struct BayStyle {
    double width = 1.0, height = 1.0, sill = 0.0, shift = 0.0;
    bool blank = false;
  };

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
    shape.width_m = door ? 1.1 : std::min(o_.window_width_m * style.width, plan_.axes[axis].bay_m - 0.5);
    const double sill = door ? 0.0 : std::max(0.08, o_.sill_m + style.sill);
    const double top_room = room.ceiling_m - room.floor_m - 0.12;
    shape.height_m = std::min(door ? 2.1 : o_.window_height_m * style.height, top_room - sill - o_.splay_m);
    u += door ? 0.0 : style.shift;
    // A partition or an end of the façade may stand too near: the window is narrowed, or left out.
    const double margin = o_.splay_m + 0.3;
    const double left = std::max(u - 0.5 * shape.width_m, pair.begin_m + margin);
    const double right = std::min(u + 0.5 * shape.width_m, pair.end_m - margin);
    if (right - left < 0.5 || shape.height_m < 0.4) return;
    shape.width_m = right - left;
    shape.splay_m = door ? 0.0 : o_.splay_m;
    shape.frame_depth_m = std::min(o_.frame_depth_m, pair.thickness_m - 0.08);
    shape.bar_m = o_.bar_m;
    shape.mullions = shape.width_m < 0.7 ? 0 : o_.mullions;
    shape.transoms = shape.height_m < 1.2 ? 0 : o_.transoms;
    if (!door && random_.uniform() < o_.curtain_share)
      shape.cover = random_.uniform() < 0.65 ? Cover::curtain : Cover::blind;
    place(shape, pair, {left, room.floor_m + sill});
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

  void add_door(const WallPair& pair) {
    OpeningShape shape;
    shape.kind = random_.uniform() < o_.open_door_share ? OpeningKind::open_door : OpeningKind::closed_door;
    shape.width_m = o_.door_width_m;
    const WallFace& inner = faces_[pair.inner];
    const WallFace& outer = faces_[pair.outer];
    shape.height_m = std::min(o_.door_height_m, std::min(inner.high_m, outer.high_m) - inner.low_m - 0.1);
    shape.leaf_angle_rad = radians(random_.uniform(80.0, 115.0));
    shape.hinge_left = random_.uniform() < 0.5;
    const double left = random_.uniform(pair.begin_m + 0.2, pair.end_m - 0.2 - shape.width_m);
    // The leaf lies against the nearer end of the wall.
    shape.hinge_left = left - pair.begin_m < pair.end_m - left - shape.width_m;
    place(shape, pair, {left, inner.low_m});
  }

  /// Cuts the opening into both faces, adds its parts and its truth. `at`: lower left on the outer face.
  void place(OpeningShape shape, const WallPair& pair, const Vector2d& at) {
    const WallFace& outer = faces_[pair.outer];
    const PlaneFrame frame = outer.frame();
    shape.id = static_cast<int>(world_.openings.size());
    shape.thickness_m = pair.thickness_m;
    shape.outer = frame;
    shape.outer.origin = frame.to_space({at.x(), at.y() - outer.low_m});
    cut(pair.outer, shape.outer_corners());
    cut(pair.inner, shape.inner_corners());
    add_opening_parts(world_.mesh, shape, random_);
    record(shape, pair);
    keep_clear(shape, pair);
  }

  void cut(std::size_t face, const std::array<Vector3d, 4>& corners) {
    const PlaneFrame frame = faces_[face].frame();
    const Vector2d p = frame.to_plane(corners[0]);
    const Vector2d q = frame.to_plane(corners[2]);
    holes_[face].push_back({std::min(p.x(), q.x()), p.y(), std::max(p.x(), q.x()), q.y()});
  }

  void record(const OpeningShape& shape, const WallPair& pair) {
    TrueOpening opening;
    opening.kind = shape.kind == OpeningKind::window ? "window" : "door";
    opening.outer = shape.outer_corners();
    opening.inner = shape.inner_corners();
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

  void add_walls() {
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      const WallFace& wall = faces_[face];
      world_.mesh.add_panel(wall.frame(), {wall.length(), wall.high_m - wall.low_m}, holes_[face],
                            surface_of(Element::wall));
    }
  }

  void add_slabs() {
    for (std::size_t room = 0; room < plan_.rooms.size(); ++room) {
      const Room& r = plan_.rooms[room];
      add_level(r, r.floor_m, true, stairs_reach(room, -1));
      add_level(r, r.ceiling_m, false, stairs_reach(room, 1));
    }
    const double z = plan_.roof_m;
    const Ring& e = plan_.envelope;
    const auto roof = [&](std::vector<std::size_t> corners) {
      std::vector<Vector3d> ring;
      for (const std::size_t i : corners) ring.emplace_back(e[i].x(), e[i].y(), z);
      world_.mesh.add_polygon(ring, surface_of(Element::roof));
    };
    if (e.size() == 4) return roof({0, 1, 2, 3});
    roof({0, 1, 4, 5});
    roof({1, 2, 3, 4});
  }

  /// Whether the stairs pass through the floor (step -1) or the ceiling (+1) of a room.
  [[nodiscard]] bool stairs_reach(std::size_t room, int step) const {
    const Room& r = plan_.rooms[room];
    if (r.use != RoomUse::stairs) return false;
    const auto same = [&](const Room& other) {
      return other.use == RoomUse::stairs && other.storey == r.storey + step;
    };
    return std::any_of(plan_.rooms.begin(), plan_.rooms.end(), same);
  }

  void add_level(const Room& room, double z, bool up, bool hole) {
    const Surface like = surface_of(up ? Element::floor : Element::ceiling);
    if (hole) {
      const Vector2d a = room.outline[0];
      const Vector2d size((room.outline[1] - a).norm(), (room.outline[3] - a).norm());
      const Vector2d u = (room.outline[1] - a).normalized();
      const Vector2d v = (room.outline[3] - a).normalized();
      const Vector3d u3(u.x(), u.y(), 0.0);
      const Vector3d v3(v.x(), v.y(), 0.0);
      const PanelRect well = stair_well(size);
      // Seen from below the two axes change places, and the normal with them.
      if (up) {
        world_.mesh.add_panel({{a.x(), a.y(), z}, u3, v3}, size, {well}, like);
      } else {
        world_.mesh.add_panel({{a.x(), a.y(), z}, v3, u3}, {size.y(), size.x()},
                              {{well.v0, well.u0, well.v1, well.u1}}, like);
      }
      return;
    }
    std::vector<Vector3d> ring;
    for (const Vector2d& p : room.outline) ring.emplace_back(p.x(), p.y(), z);
    if (!up) std::reverse(ring.begin(), ring.end());
    world_.mesh.add_polygon(ring, like);
  }

  /// The hole for the stairs in a stair room of `size`: along its second side.
  static PanelRect stair_well(const Vector2d& size) { return {0.05, 1.1, 1.2, size.y() - 0.9}; }

  void add_stairs() {
    for (std::size_t room = 0; room < plan_.rooms.size(); ++room)
      if (stairs_reach(room, 1)) add_flight(plan_.rooms[room], room);
  }

  void add_flight(const Room& room, std::size_t index) {
    const Vector2d a = room.outline[0];
    const Vector2d u = (room.outline[1] - a).normalized();
    const Vector2d v = (room.outline[3] - a).normalized();
    const PanelRect well = stair_well({(room.outline[1] - a).norm(), (room.outline[3] - a).norm()});
    const double rise = next_floor(room) - room.floor_m;
    const int steps = static_cast<int>(std::lround(rise / 0.175));
    const double going = (well.v1 - well.v0) / steps;
    const double yaw = std::atan2(u.y(), u.x());
    for (int i = 0; i < steps; ++i) {
      const Vector2d p = a + 0.5 * (well.u0 + well.u1) * u + (well.v0 + (i + 0.5) * going) * v;
      const double height = rise / steps;
      world_.mesh.add_box({{p.x(), p.y(), room.floor_m + i * height}, yaw},
                          {well.u1 - well.u0 - 0.02, going, height}, surface_of(Element::stairs));
    }
    add_well_sides(room, well, u, v);
    const Vector2d centre = a + 0.5 * (well.u0 + well.u1) * u + 0.5 * (well.v0 + well.v1) * v;
    building_.occupied[index].push_back(
        {rectangle_ring(centre, u, {well.u1 - well.u0 + 0.4, well.v1 - well.v0 + 1.0}), 0.0});
  }

  [[nodiscard]] double next_floor(const Room& room) const {
    for (const Room& other : plan_.rooms)
      if (other.use == RoomUse::stairs && other.storey == room.storey + 1) return other.floor_m;
    return room.ceiling_m;
  }

  /// The slab's thickness seen in the stair well.
  void add_well_sides(const Room& room, const PanelRect& well, const Vector2d& u, const Vector2d& v) {
    const Vector2d a = room.outline[0];
    const auto corner = [&](double x, double y) { return Vector2d(a + x * u + y * v); };
    const Ring ring = {corner(well.u0, well.v0), corner(well.u1, well.v0), corner(well.u1, well.v1),
                       corner(well.u0, well.v1)};
    for (std::size_t i = 0; i < 4; ++i) {
      const WallFace side{ring[i], ring[(i + 1) % 4], room.ceiling_m, next_floor(room), 0};
      world_.mesh.add_panel(side.frame(), {side.length(), side.high_m - side.low_m}, {},
                            surface_of(Element::reveal));
    }
  }

  /// A band along an envelope edge, proud of the wall.
  void add_band(std::size_t edge, double low, double high, double proud) {
    const Vector2d a = plan_.envelope[edge];
    const Vector2d b = plan_.envelope[(edge + 1) % plan_.envelope.size()];
    const Vector2d along = (b - a).normalized();
    const Vector2d out(along.y(), -along.x());
    const Vector2d middle = 0.5 * (a + b) + 0.5 * proud * out;
    world_.mesh.add_box({{middle.x(), middle.y(), low}, std::atan2(along.y(), along.x())},
                        {(b - a).norm() + 2.0 * proud, proud, high - low}, surface_of(Element::ornament));
  }

  void add_outside() {
    const bool plinth = random_.uniform() < o_.ornament_share;
    const bool courses = random_.uniform() < o_.ornament_share;
    const bool cornice = random_.uniform() < o_.ornament_share;
    double ground = plan_.roof_m;
    int top_storey = 0;
    for (const Room& room : plan_.rooms) {
      ground = std::min(ground, room.floor_m);
      top_storey = std::max(top_storey, room.storey);
    }
    const double course = random_.uniform(0.04, 0.1);
    const double overhang = random_.uniform(0.15, 0.35);
    for (std::size_t edge = 0; edge < plan_.envelope.size(); ++edge) {
      if (plinth && ground > 0.25) add_band(edge, plan_.base_m, ground - 0.06, 0.05);
      if (cornice) add_band(edge, plan_.roof_m - 0.3, plan_.roof_m, overhang);
      for (int storey = 1; courses && storey <= top_storey; ++storey) {
        const double level = floor_of(storey);
        add_band(edge, level - 0.2, level - 0.02, course);
      }
    }
  }

  [[nodiscard]] double floor_of(int storey) const {
    for (const Room& room : plan_.rooms)
      if (room.storey == storey) return room.floor_m;
    return plan_.roof_m;
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
  std::vector<WallPair> pairs_;
  std::vector<BayStyle> bays_;
  int entrance_axis_ = -1;
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
