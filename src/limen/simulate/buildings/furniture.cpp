// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/buildings/building.h"

namespace limen {
namespace {

/// A box of a piece of furniture: middle (x along, y into the room, z up from the floor) and size.
struct FurniturePart {
  Vector3d middle;  ///< x, y of the middle, z of the bottom
  Vector3d size;
};

/// A piece in its own frame: x along the wall, y into the room from its back, footprint width x depth.
struct FurniturePiece {
  Vector2d footprint = Vector2d::Zero();
  double height = 0.0;
  std::vector<FurniturePart> parts;
};

FurniturePiece box_piece(const Vector3d& size) {
  return {size.head<2>(), size.z(), {{{0.0, 0.5 * size.y(), 0.0}, size}}};
}

FurniturePiece cupboard(RandomStream& r) {
  return box_piece(uniform_vector(Vector3d(0.7, 0.38, 1.55), Vector3d(1.7, 0.65, 2.15), r));
}

FurniturePiece sideboard(RandomStream& r) {
  return box_piece(uniform_vector(Vector3d(0.8, 0.38, 0.65), Vector3d(1.8, 0.5, 0.95), r));
}

FurniturePiece shelf(RandomStream& r) {
  const double w = r.uniform(0.8, 1.4);
  const double d = r.uniform(0.26, 0.36);
  const double h = r.uniform(1.6, 2.2);
  FurniturePiece piece{{w, d}, h, {}};
  piece.parts.push_back({{0.0, 0.01, 0.0}, {w, 0.02, h}});
  for (const double side : {-1.0, 1.0})
    piece.parts.push_back({{side * (0.5 * w - 0.012), 0.5 * d, 0.0}, {0.024, d, h}});
  const int boards = 4 + static_cast<int>(r.below(3));
  for (int i = 0; i <= boards; ++i) {
    const double z = (h - 0.024) * i / boards;
    piece.parts.push_back({{0.0, 0.5 * d, z}, {w - 0.05, d - 0.01, 0.024}});
    if (i == boards) break;
    // Books fill a part of each board.
    const double filled = (w - 0.06) * r.uniform(0.2, 0.95);
    piece.parts.push_back({{-0.5 * (w - 0.06) + 0.5 * filled, 0.3 * d + 0.04, z + 0.024},
                           {filled, 0.55 * d, (h / boards - 0.03) * r.uniform(0.5, 0.85)}});
  }
  return piece;
}

FurniturePiece bed(RandomStream& r) {
  const double w = r.uniform(0.9, 1.8);
  FurniturePiece piece{{w, 2.05}, 1.0, {}};
  piece.parts.push_back({{0.0, 1.05, 0.12}, {w, 2.0, 0.28}});
  piece.parts.push_back({{0.0, 0.03, 0.0}, {w, 0.06, r.uniform(0.7, 1.0)}});
  piece.parts.push_back({{0.0, 1.05, 0.4}, {w - 0.06, 1.9, 0.1}});
  piece.parts.push_back({{0.0, 0.32, 0.5}, {0.75 * w, 0.4, 0.1}});
  return piece;
}

void add_legs(FurniturePiece& piece, const Vector2d& middle, const Vector2d& size, double height) {
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      piece.parts.push_back(
          {{middle.x() + x * (0.5 * size.x() - 0.04), middle.y() + y * (0.5 * size.y() - 0.04), 0.0},
           {0.045, 0.045, height}});
}

FurniturePiece desk(RandomStream& r) {
  const double w = r.uniform(1.1, 1.8);
  const double d = r.uniform(0.6, 0.8);
  const double h = r.uniform(0.71, 0.78);
  FurniturePiece piece{{w, d}, 1.25, {}};
  piece.parts.push_back({{0.0, 0.5 * d, h - 0.03}, {w, d, 0.03}});
  add_legs(piece, {0.0, 0.5 * d}, {w, d}, h - 0.03);
  const double x = r.uniform(-0.25, 0.25) * w;
  piece.parts.push_back({{x, 0.25 * d, h}, {0.2, 0.15, 0.12}});
  piece.parts.push_back({{x, 0.25 * d + 0.03, h + 0.12}, {0.58, 0.05, 0.34}});
  return piece;
}

FurniturePiece sofa(RandomStream& r) {
  const double w = r.uniform(1.4, 2.3);
  FurniturePiece piece{{w, 0.9}, 0.85, {}};
  piece.parts.push_back({{0.0, 0.5, 0.08}, {w - 0.36, 0.8, 0.34}});
  piece.parts.push_back({{0.0, 0.12, 0.0}, {w, 0.22, r.uniform(0.72, 0.85)}});
  for (const double side : {-1.0, 1.0})
    piece.parts.push_back({{side * (0.5 * w - 0.09), 0.56, 0.0}, {0.18, 0.66, 0.6}});
  return piece;
}

void add_chair(FurniturePiece& piece, const Vector2d& at, const Vector2d& back, double seat) {
  piece.parts.push_back({{at.x(), at.y(), seat - 0.04}, {0.42, 0.42, 0.04}});
  add_legs(piece, at, {0.42, 0.42}, seat - 0.04);
  const bool along_x = std::abs(back.x()) > std::abs(back.y());
  const Vector2d middle = at + 0.195 * back;
  piece.parts.push_back(
      {{middle.x(), middle.y(), seat}, {along_x ? 0.03 : 0.42, along_x ? 0.42 : 0.03, 0.42}});
}

FurniturePiece table(RandomStream& r) {
  const double w = r.uniform(0.9, 2.2);
  const double d = r.uniform(0.75, 1.05);
  const double h = r.uniform(0.7, 0.78);
  const double reach = 0.45;
  FurniturePiece piece{{w + 2.0 * reach, d + 2.0 * reach}, 0.95, {}};
  const Vector2d middle(0.0, 0.5 * d + reach);
  piece.parts.push_back({{0.0, middle.y(), h - 0.035}, {w, d, 0.035}});
  add_legs(piece, middle, {w, d}, h - 0.035);
  const double seat = r.uniform(0.43, 0.48);
  const int chairs = std::max(1, static_cast<int>(w / 0.65));
  for (int i = 0; i < chairs; ++i) {
    const double x = w * ((i + 0.5) / chairs - 0.5);
    for (const double side : {-1.0, 1.0}) {
      if (r.uniform() < 0.2) continue;
      const Vector2d at = middle + Vector2d(x, side * (0.5 * d + r.uniform(-0.05, 0.2)));
      add_chair(piece, at, {0.0, side}, seat);
    }
  }
  return piece;
}

FurniturePiece display_case(RandomStream& r) {
  const double w = r.uniform(0.7, 1.6);
  const double d = r.uniform(0.5, 0.8);
  FurniturePiece piece = box_piece({w, d, r.uniform(0.75, 1.05)});
  const double top = piece.parts[0].size.z();
  // An exhibit on it, in a few blocks.
  for (int i = 0; i < 3; ++i)
    piece.parts.push_back({{r.uniform(-0.25, 0.25) * w, d * r.uniform(0.35, 0.65), top},
                           {r.uniform(0.08, 0.3), r.uniform(0.08, 0.3), r.uniform(0.1, 0.6)}});
  piece.height = top + 0.6;
  return piece;
}

/// Puts pieces into one room.
class FurnitureDecorator {
 public:
  FurnitureDecorator(World& world, std::size_t building, std::size_t room, RandomStream& random)
      : mesh_(world.mesh),
        building_(world.buildings[building]),
        index_(room),
        room_(building_.plan.rooms[room]),
        random_(random) {
    // Spare space: the room's own outline decides; a doorway's floor is in the list of taken areas.
  }

  void run(double fullness) {
    const double size = signed_area(room_.outline);
    const auto count = [&](double per_m2) { return static_cast<int>(std::lround(fullness * per_m2 * size)); };
    add_structure();
    switch (room_.use) {
      case RoomUse::living:
        along_walls(count(0.4), {cupboard, sideboard, shelf, bed, sofa, desk});
        break;
      case RoomUse::office:
        along_walls(count(0.35), {cupboard, shelf, desk, desk, sideboard});
        break;
      case RoomUse::exhibition:
        along_walls(count(0.25), {display_case, cupboard, display_case, shelf});
        break;
      default:
        along_walls(count(0.12), {sideboard, cupboard});
        break;
    }
    if (room_.use == RoomUse::exhibition) free_standing(count(0.06), display_case);
    if (room_.use == RoomUse::living || room_.use == RoomUse::office) free_standing(count(0.07) + 1, table);
    pictures(count(0.12));
    lamps(room_.use == RoomUse::corridor ? 2 : 1 + static_cast<int>(size / 25.0));
  }

 private:
  using Maker = FurniturePiece (*)(RandomStream&);

  /// A chimney breast against a wall, in large halls a row of pillars: solids that reach the ceiling.
  void add_structure() {
    const double height = room_.ceiling_m - room_.floor_m;
    if (random_.uniform() < 0.45) {
      const Vector2d foot = uniform_vector(Vector2d(0.8, 0.2), Vector2d(1.7, 0.5), random_);
      const FurniturePiece breast = box_piece({foot.x(), foot.y(), height});
      for (int attempt = 0; attempt < 12; ++attempt)
        if (try_at_wall(breast, 0.0, surface_of(Element::wall))) break;
    }
    if (signed_area(room_.outline) < 45.0) return;
    const double side = random_.uniform(0.3, 0.5);
    for (int i = 0; i < 2; ++i) try_free(box_piece({side, side, height}), surface_of(Element::wall), false);
  }

  void along_walls(int count, const std::vector<Maker>& makers) {
    for (int i = 0; i < count; ++i) {
      const FurniturePiece piece = makers[random_.below(static_cast<std::uint32_t>(makers.size()))](random_);
      for (int attempt = 0; attempt < 10; ++attempt) {
        const Surface surface = wood();
        if (try_at_wall(piece, random_.uniform(0.005, 0.05), surface)) break;
      }
    }
  }

  void free_standing(int count, Maker maker) {
    for (int i = 0; i < count; ++i) {
      const Surface surface = wood();
      try_free(maker(random_), surface, true);
    }
  }

  Surface wood() {
    Surface surface = surface_of(Element::furniture);
    surface.reflectivity = random_.uniform(0.2, 0.75);
    return surface;
  }

  struct Wall {
    Vector2d a, along, in;
    double length;
  };

  Wall random_wall() {
    // Long walls are chosen more often.
    const Ring& ring = room_.outline;
    double at = random_.uniform();
    double perimeter = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
    for (std::size_t i = 0;; ++i) {
      const Vector2d edge = ring[(i + 1) % ring.size()] - ring[i];
      at -= edge.norm() / perimeter;
      if (at > 0.0 && i + 1 < ring.size()) continue;
      const Vector2d along = edge.normalized();
      return {ring[i], along, {-along.y(), along.x()}, edge.norm()};
    }
  }

  bool try_at_wall(const FurniturePiece& piece, double gap, const Surface& like) {
    const Wall wall = random_wall();
    const double free = wall.length - piece.footprint.x();
    if (free < 0.1) return false;
    const Vector2d back = wall.a +
                          (0.5 * piece.footprint.x() + random_.uniform(0.03, free - 0.03)) * wall.along +
                          gap * wall.in;
    return try_place(piece, back, wall.along, like);
  }

  void try_free(const FurniturePiece& piece, const Surface& like, bool turned) {
    const auto [low, high] = box_of(room_.outline);
    for (int attempt = 0; attempt < 25; ++attempt) {
      const Vector2d at = uniform_vector(low, high, random_);
      const Wall wall = random_wall();
      const double turn = turned && random_.uniform() < 0.3 ? random_.uniform(-0.6, 0.6) : 0.0;
      const Vector2d along(std::cos(turn) * wall.along.x() - std::sin(turn) * wall.along.y(),
                           std::sin(turn) * wall.along.x() + std::cos(turn) * wall.along.y());
      if (try_place(piece, at, along, like)) return;
    }
  }

  /// `back`: the middle of the piece's back edge.
  bool try_place(const FurniturePiece& piece, const Vector2d& back, const Vector2d& along,
                 const Surface& like) {
    const Vector2d in(-along.y(), along.x());
    const Ring area = rectangle_ring(back + 0.5 * piece.footprint.y() * in, along, piece.footprint);
    if (!fits(area, piece.footprint, piece.height)) return false;
    const double yaw = std::atan2(along.y(), along.x());
    for (const FurniturePart& part : piece.parts) {
      const Vector2d p = back + part.middle.x() * along + part.middle.y() * in;
      mesh_.add_box({{p.x(), p.y(), room_.floor_m + part.middle.z()}, yaw}, part.size, like);
    }
    building_.occupied[index_].push_back({area, 0.0, true});
    return true;
  }

  /// Whether a rectangle of floor is inside the room and free, sampled on a fine grid.
  [[nodiscard]] bool fits(const Ring& area, const Vector2d& size, double height) const {
    const int nu = 2 + static_cast<int>(size.x() / 0.15);
    const int nv = 2 + static_cast<int>(size.y() / 0.15);
    for (int i = 0; i <= nu; ++i) {
      for (int j = 0; j <= nv; ++j) {
        const Vector2d p = area[0] + (area[1] - area[0]) * i / nu + (area[3] - area[0]) * j / nv;
        if (!contains(room_.outline, p)) return false;
        for (const Footprint& taken : building_.occupied[index_])
          if (height > taken.from_m && contains(taken.area, p)) return false;
      }
    }
    // The other way round, for taken areas that are smaller than the grid.
    for (const Footprint& taken : building_.occupied[index_])
      for (const Vector2d& corner : taken.area)
        if (height > taken.from_m && contains(area, corner)) return false;
    return true;
  }

  /// Thin boxes on the walls, above the furniture.
  void pictures(int count) {
    for (int i = 0; i < count; ++i) {
      const Wall wall = random_wall();
      const double w = random_.uniform(0.3, 1.2);
      const double h = random_.uniform(0.3, 0.6);
      if (wall.length < w + 0.2) continue;
      const Vector2d back = wall.a + random_.uniform(0.5 * w + 0.1, wall.length - 0.5 * w - 0.1) * wall.along;
      const Ring area = rectangle_ring(back + 0.06 * wall.in, wall.along, {w, 0.04});
      if (!fits(area, {w, 0.04}, 2.0)) continue;
      const Vector2d p = back + 0.0125 * wall.in;
      const Surface surface = wood();
      mesh_.add_box({{p.x(), p.y(), room_.floor_m + random_.uniform(1.35, 1.5)},
                     std::atan2(wall.along.y(), wall.along.x())},
                    {w, 0.025, h}, surface);
      building_.occupied[index_].push_back({area, 1.0});
    }
  }

  /// Lamps hang where they hang: high enough to be in nobody's way.
  void lamps(int count) {
    Vector2d middle = Vector2d::Zero();
    for (const Vector2d& p : room_.outline) middle += p / static_cast<double>(room_.outline.size());
    for (int i = 0; i < count; ++i) {
      const Vector2d corner = room_.outline[random_.below(static_cast<std::uint32_t>(room_.outline.size()))];
      const Vector2d p = middle + random_.uniform(0.0, 0.5) * (corner - middle);
      const double size = random_.uniform(0.25, 0.5);
      const double drop = random_.uniform(0.0, 0.4);
      const double z = room_.ceiling_m - drop - 0.14;
      if (drop > 0.03) mesh_.add_box({{p.x(), p.y(), z + 0.13}, 0.0}, {0.02, 0.02, drop + 0.01}, wood());
      const Surface surface = wood();
      const double width = size * random_.uniform(0.4, 1.0);
      mesh_.add_box({{p.x(), p.y(), z}, random_.uniform(0.0, 3.0)}, {size, width, 0.13}, surface);
    }
  }

  Mesh& mesh_;
  Building& building_;
  std::size_t index_;
  const Room& room_;
  RandomStream& random_;
};

}  // namespace

void furnish(World& world, std::size_t building, std::size_t room, double fullness, RandomStream& random) {
  if (fullness <= 0.0) return;
  const MeshMark begin = world.mesh.mark();
  FurnitureDecorator(world, building, room, random).run(fullness);
  remember_furniture(world, building, room, begin);
}

bool is_free(const Building& building, std::size_t room, const Vector2d& p, double radius_m) {
  const auto inside_all = [&](const Vector2d& q) {
    if (!contains(building.plan.rooms[room].outline, q)) return false;
    return std::none_of(
        building.occupied[room].begin(), building.occupied[room].end(),
        [&](const Footprint& taken) { return taken.from_m < 0.5 && contains(taken.area, q); });
  };
  for (const double radius : {0.5 * radius_m, radius_m}) {
    for (int i = 0; i < 16; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 16;
      if (!inside_all(p + radius * Vector2d(std::cos(angle), std::sin(angle)))) return false;
    }
  }
  return inside_all(p);
}

}  // namespace limen
