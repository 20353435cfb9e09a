// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/shell.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

/// The axes of a rectangular room: from its first corner along its first and last side.
struct RoomAxes {
  Vector2d corner, u, v, size;

  explicit RoomAxes(const Room& room)
      : corner(room.outline[0]),
        u((room.outline[1] - corner).normalized()),
        v((room.outline[3] - corner).normalized()),
        size((room.outline[1] - corner).norm(), (room.outline[3] - corner).norm()) {}

  [[nodiscard]] Vector2d at(double x, double y) const { return corner + x * u + y * v; }
};

Vector3d level(const Vector2d& p, double z) {
  return {p.x(), p.y(), z};
}

/// The hole for the stairs in the slab of a stair room, along its second side.
PanelRect stair_well(const Vector2d& size) {
  return {0.05, 1.1, 1.2, size.y() - 0.9};
}

/// A plan may have more than one staircase: the rooms of one lie above one another. With a single one they
/// are the same even where the partition differs from storey to storey.
bool same_shaft(const FloorPlan& plan, const Room& room, const Room& other) {
  if (plan.doors.empty()) return true;
  return (room.outline[0] - other.outline[0]).norm() < 0.01;
}

/// The stair room `step` storeys above, or null.
const Room* stairs_beyond(const FloorPlan& plan, const Room& room, int step) {
  if (room.use != RoomUse::stairs) return nullptr;
  for (const Room& other : plan.rooms)
    if (other.use == RoomUse::stairs && other.storey == room.storey + step && same_shaft(plan, room, other))
      return &other;
  return nullptr;
}

class ShellBuilder {
 public:
  ShellBuilder(Mesh& mesh, const ShellPlan& shell) : mesh_(mesh), shell_(shell), plan_(shell.plan) {}

  void add_walls() {
    if (shell_.built) return add_walls_as_built();
    for (std::size_t i = 0; i < shell_.faces.size(); ++i) {
      const WallFace& wall = shell_.faces[i];
      const PlaneFrame frame = wall.frame();
      const int id = mesh_.add_panel(frame, {wall.length(), wall.high_m - wall.low_m}, shell_.holes[i],
                                     surface_of(Element::wall));
      for (const PanelTriangle& t : shell_.spandrels[i])
        mesh_.add_triangle(frame.to_space(t[0]), frame.to_space(t[1]), frame.to_space(t[2]), id);
    }
  }

  void add_slabs() {
    if (shell_.built) return add_slabs_as_built();
    for (const Room& room : plan_.rooms) {
      add_level(room, room.floor_m, true, stairs_beyond(plan_, room, -1) != nullptr);
      add_level(room, room.ceiling_m, false, stairs_beyond(plan_, room, 1) != nullptr);
    }
    // With two wings the envelope has six corners: one convex piece of roof for each wing.
    if (plan_.envelope.size() == 4) return add_roof({0, 1, 2, 3});
    add_roof({0, 1, 4, 5});
    add_roof({1, 2, 3, 4});
  }

  void add_stairs() {
    for (const Room& room : plan_.rooms) {
      const Room* above = stairs_beyond(plan_, room, 1);
      if (above == nullptr) continue;
      const MeshMark begin = mesh_.mark();
      add_flight(room, above->floor_m);
      if (!shell_.built) {
        add_well_sides(room, above->floor_m);
        continue;
      }
      mesh_.map(begin, mesh_.mark(), shell_.built->shape.in_room(index_of(room)));
      add_well_sides_as_built(room, *above);
    }
  }

  void add_ornaments(double share, RandomStream& random) {
    const bool plinth = random.uniform() < share;
    const bool courses = random.uniform() < share;
    const bool cornice = random.uniform() < share;
    const double course = random.uniform(0.04, 0.1);
    const double overhang = random.uniform(0.15, 0.35);
    const std::vector<double> floors = floor_levels();
    for (std::size_t edge = 0; edge < plan_.envelope.size(); ++edge) {
      const MeshMark begin = mesh_.mark();
      if (plinth && floors[0] > 0.25) add_band(edge, {plan_.base_m, floors[0] - 0.06}, 0.05);
      if (cornice) add_band(edge, {plan_.roof_m - 0.3, plan_.roof_m}, overhang);
      for (std::size_t storey = 1; courses && storey < floors.size(); ++storey)
        add_band(edge, {floors[storey] - 0.2, floors[storey] - 0.02}, course);
      if (shell_.built)
        mesh_.map(begin, mesh_.mark(),
                  shell_.built->shape.at_face(shell_.built->shape.outside().faces[edge]));
    }
  }

 private:
  void add_walls_as_built() {
    const ShellAsBuilt& built = *shell_.built;
    for (std::size_t i = 0; i < shell_.faces.size(); ++i) {
      Surface surface = surface_of(Element::wall);
      surface.bulge = built.shape.bulge(i);
      mesh_.add_quad_panel(built.shape.corners(i), built.shape.wall(i), built.holes[i], surface);
    }
  }

  [[nodiscard]] std::size_t index_of(const Room& room) const {
    return static_cast<std::size_t>(&room - plan_.rooms.data());
  }

  void add_slabs_as_built() {
    for (const Room& room : plan_.rooms) {
      const BuiltSpace& space = shell_.built->shape.room(index_of(room));
      add_level_as_built(space.low, space.low_corners, Element::floor, stairs_beyond(plan_, room, -1));
      add_level_as_built(space.high, space.high_corners, Element::ceiling,
                         stairs_beyond(plan_, room, 1) != nullptr ? &room : nullptr);
    }
    const BuiltSpace& outside = shell_.built->shape.outside();
    const auto add = [&](const std::vector<std::size_t>& corners) {
      std::vector<Vector3d> ring;
      for (const std::size_t i : corners) ring.push_back(outside.high_corners[i]);
      add_flat(ring, outside.high, Element::roof);
    };
    if (outside.faces.size() == 4) return add({0, 1, 2, 3});
    add({0, 1, 4, 5});
    add({1, 2, 3, 4});
  }

  void add_flat(const std::vector<Vector3d>& ring, const Plane& plane, Element element) {
    Surface surface = surface_of(element);
    surface.plane = plane;
    const int id = mesh_.add_surface(surface);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) mesh_.add_triangle(ring[0], ring[i], ring[i + 1], id);
  }

  /// `below`: the room whose stairs come through, or null. Floors and ceilings reach some tenths of a
  /// millimetre under and above the walls: no ray slips through between them.
  void add_level_as_built(const Plane& plane, const std::vector<Vector3d>& corners, Element element,
                          const Room* below) {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& corner : corners) middle += corner / static_cast<double>(corners.size());
    std::vector<Vector3d> ring;
    for (const Vector3d& corner : corners) ring.emplace_back(middle + 1.0001 * (corner - middle));
    if (element == Element::ceiling) std::reverse(ring.begin(), ring.end());
    if (below == nullptr) return add_flat(ring, plane, element);
    mesh_.add_quad_panel({ring[0], ring[1], ring[2], ring[3]}, plane, {well_ring(*below, plane)},
                         surface_of(element));
  }

  /// The edges of the well above a room's stairs are upright; this is where they meet a plane.
  [[nodiscard]] std::vector<Vector3d> well_ring(const Room& room, const Plane& plane) const {
    const RoomAxes axes(room);
    const PanelRect well = stair_well(axes.size);
    std::vector<Vector3d> ring;
    for (const Vector2d& p : {axes.at(well.u0, well.v0), axes.at(well.u1, well.v0), axes.at(well.u1, well.v1),
                              axes.at(well.u0, well.v1)})
      ring.push_back(level(p, (plane.offset - plane.normal.head<2>().dot(p)) / plane.normal.z()));
    return ring;
  }

  void add_well_sides_as_built(const Room& room, const Room& above) {
    const AsBuilt& shape = shell_.built->shape;
    const std::vector<Vector3d> low = well_ring(room, shape.room(index_of(room)).high);
    const std::vector<Vector3d> high = well_ring(room, shape.room(index_of(above)).low);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      mesh_.add_polygon({low[next], low[i], high[i], high[next]}, surface_of(Element::reveal));
    }
  }

  void add_level(const Room& room, double z, bool up, bool hole) {
    const Surface like = surface_of(up ? Element::floor : Element::ceiling);
    if (hole) return add_level_with_well(room, z, up, like);
    std::vector<Vector3d> ring;
    for (const Vector2d& p : room.outline) ring.push_back(level(p, z));
    if (!up) std::reverse(ring.begin(), ring.end());
    mesh_.add_polygon(ring, like);
  }

  void add_level_with_well(const Room& room, double z, bool up, const Surface& like) {
    const RoomAxes axes(room);
    const PanelRect well = stair_well(axes.size);
    const PlaneFrame frame{level(axes.corner, z), level(axes.u, 0.0), level(axes.v, 0.0)};
    if (up) {
      mesh_.add_panel(frame, axes.size, {well}, like);
      return;
    }
    // Seen from below the two axes change places, and the normal with them.
    mesh_.add_panel({frame.origin, frame.v, frame.u}, {axes.size.y(), axes.size.x()},
                    {{well.v0, well.u0, well.v1, well.u1}}, like);
  }

  void add_roof(const std::vector<std::size_t>& corners) {
    std::vector<Vector3d> ring;
    ring.reserve(corners.size());
    for (const std::size_t i : corners) ring.push_back(level(plan_.envelope[i], plan_.roof_m));
    mesh_.add_polygon(ring, surface_of(Element::roof));
  }

  void add_flight(const Room& room, double top) {
    const RoomAxes axes(room);
    const PanelRect well = stair_well(axes.size);
    const double rise = top - room.floor_m;
    const int steps = static_cast<int>(std::lround(rise / 0.175));
    const double going = (well.v1 - well.v0) / steps;
    const double height = rise / steps;
    for (int i = 0; i < steps; ++i) {
      const Vector2d p = axes.at(0.5 * (well.u0 + well.u1), well.v0 + (i + 0.5) * going);
      mesh_.add_box({level(p, room.floor_m + i * height), std::atan2(axes.u.y(), axes.u.x())},
                    {well.u1 - well.u0 - 0.02, going, height}, surface_of(Element::stairs));
    }
  }

  /// The slab's thickness as it shows in the stair well.
  void add_well_sides(const Room& room, double top) {
    const RoomAxes axes(room);
    const PanelRect well = stair_well(axes.size);
    const Ring ring = {axes.at(well.u0, well.v0), axes.at(well.u1, well.v0), axes.at(well.u1, well.v1),
                       axes.at(well.u0, well.v1)};
    for (std::size_t i = 0; i < 4; ++i) {
      const WallFace side{ring[i], ring[(i + 1) % 4], room.ceiling_m, top, 0};
      mesh_.add_panel(side.frame(), {side.length(), side.high_m - side.low_m}, {},
                      surface_of(Element::reveal));
    }
  }

  /// A band along an envelope edge between two heights, proud of the wall.
  void add_band(std::size_t edge, const Vector2d& heights, double proud) {
    const Vector2d a = plan_.envelope[edge];
    const Vector2d b = plan_.envelope[(edge + 1) % plan_.envelope.size()];
    const Vector2d along = (b - a).normalized();
    const Vector2d out(along.y(), -along.x());
    mesh_.add_box({level(0.5 * (a + b) + 0.5 * proud * out, heights.x()), std::atan2(along.y(), along.x())},
                  {(b - a).norm() + 2.0 * proud, proud, heights.y() - heights.x()},
                  surface_of(Element::ornament));
  }

  [[nodiscard]] std::vector<double> floor_levels() const {
    std::vector<double> levels;
    for (const Room& room : plan_.rooms) levels.push_back(room.floor_m);
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
  }

  Mesh& mesh_;
  const ShellPlan& shell_;
  const FloorPlan& plan_;
};

}  // namespace

void add_shell(Mesh& mesh, const ShellPlan& shell, double ornament_share, RandomStream& random) {
  ShellBuilder builder(mesh, shell);
  builder.add_walls();
  builder.add_slabs();
  builder.add_stairs();
  builder.add_ornaments(ornament_share, random);
}

bool stairs_rise(const FloorPlan& plan, std::size_t room) {
  return stairs_beyond(plan, plan.rooms[room], 1) != nullptr;
}

Ring stairs_area(const Room& room) {
  const RoomAxes axes(room);
  const PanelRect well = stair_well(axes.size);
  const double x0 = well.u0 - 0.2;
  const double x1 = well.u1 + 0.2;
  return {axes.at(x0, well.v0 - 0.5), axes.at(x1, well.v0 - 0.5), axes.at(x1, well.v1 + 0.5),
          axes.at(x0, well.v1 + 0.5)};
}

}  // namespace limen
