// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/furnishing/layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// A room seen in the frame of its design, where its mirror image is the room itself.
class DesignRoom {
 public:
  DesignRoom(const Building& building, std::size_t room)
      : room_(building.plan.rooms[room]),
        mirrored_(room_.design_x.x() * room_.design_y.y() - room_.design_x.y() * room_.design_y.x() < 0.0) {
    outline_ = ring_in(room_.outline);
    for (const Footprint& taken : building.occupied[room])
      taken_.push_back({ring_in(taken.area), taken.from_m, taken.piece});
  }

  [[nodiscard]] const Ring& outline() const { return outline_; }
  [[nodiscard]] const Room& room() const { return room_; }
  [[nodiscard]] bool mirrored() const { return mirrored_; }

  [[nodiscard]] Vector2d to_plan(const Vector2d& p) const {
    return room_.design_origin + p.x() * room_.design_x + p.y() * room_.design_y;
  }
  [[nodiscard]] Vector2d direction_to_plan(const Vector2d& d) const {
    return d.x() * room_.design_x + d.y() * room_.design_y;
  }
  [[nodiscard]] Vector2d to_design(const Vector2d& p) const {
    const Vector2d off = p - room_.design_origin;
    return {room_.design_x.dot(off), room_.design_y.dot(off)};
  }

  void take(const Footprint& footprint) { taken_.push_back(footprint); }

  /// Whether a rectangle of floor is inside the room and free for something of this height.
  [[nodiscard]] bool fits(const Ring& area, double height) const {
    for (const Vector2d& corner : area)
      if (!inside(corner)) return false;
    return std::none_of(taken_.begin(), taken_.end(), [&](const Footprint& taken) {
      return height > taken.from_m && overlap(area, taken.area);
    });
  }

 private:
  [[nodiscard]] Ring ring_in(const Ring& ring) const {
    Ring result;
    for (const Vector2d& p : ring) result.push_back(to_design(p));
    if (mirrored_) std::reverse(result.begin(), result.end());
    return result;
  }

  [[nodiscard]] bool inside(const Vector2d& p) const {
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const Vector2d edge = outline_[(i + 1) % outline_.size()] - outline_[i];
      const Vector2d off = p - outline_[i];
      if (edge.x() * off.y() - edge.y() * off.x() < 0.0) return false;
    }
    return true;
  }

  /// Two convex rings overlap unless an edge of one has the other beyond it.
  static bool overlap(const Ring& a, const Ring& b) { return !edge_between(a, b) && !edge_between(b, a); }
  static bool edge_between(const Ring& a, const Ring& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Vector2d edge = a[(i + 1) % a.size()] - a[i];
      const bool beyond = std::all_of(b.begin(), b.end(), [&](const Vector2d& p) {
        return edge.x() * (p - a[i]).y() - edge.y() * (p - a[i]).x() <= 0.0;
      });
      if (beyond) return true;
    }
    return false;
  }

  const Room& room_;
  bool mirrored_;
  Ring outline_;
  std::vector<Footprint> taken_;
};

Vector2d left_of(const Vector2d& d) {
  return {-d.y(), d.x()};
}

Ring area_of(const PlacedPiece& placed, const Vector3d& size) {
  return rectangle_ring(placed.back + 0.5 * size.y() * left_of(placed.along), placed.along,
                        {size.x(), size.y()});
}

bool on_wall(PieceKind kind) {
  return kind == PieceKind::picture;
}

/// What a piece takes of the room: pictures what is above a metre, lamps nothing.
std::optional<Footprint> footprint_of(const PlacedPiece& placed) {
  if (placed.piece.kind == PieceKind::ceiling_lamp || placed.piece.kind == PieceKind::radiator)
    return std::nullopt;
  const Vector3d size = size_of(placed.piece);
  return Footprint{area_of(placed, size), on_wall(placed.piece.kind) ? 1.0 : 0.0,
                   !on_wall(placed.piece.kind)};
}

/// Finds places for pieces in one room.
class LayoutDecorator {
 public:
  LayoutDecorator(const World& world, std::size_t building, std::size_t room, RandomStream& random)
      : room_(world.buildings[building], room), random_(random) {}

  Layout run(const LayoutOptions& options) {
    const double area = signed_area(room_.outline());
    const auto count = [&](double per_m2) { return static_cast<int>(std::lround(per_m2 * area)); };
    if (room_.room().use != RoomUse::stairs) {
      hide_walls(options.hide_share);
      for (int i = 0; i < count(options.free_per_m2); ++i) try_free(any_of(free_pieces(room_.room().use)));
      for (int i = 0; i < count(options.small_per_m2); ++i) try_free(PieceKind::small_object);
    }
    for (int i = 0; i < count(options.pictures_per_m2); ++i) try_wall(PieceKind::picture, 1.4);
    return layout_;
  }

  /// Another place in the room for a piece, as good as the first one.
  std::optional<PlacedPiece> elsewhere(const PlacedPiece& placed, bool at_wall) {
    for (int attempt = 0; attempt < 30; ++attempt) {
      PlacedPiece other = placed;
      const Vector3d size = size_of(placed.piece);
      if (!(at_wall ? put_at_wall(other, size) : put_free(other, size))) continue;
      if ((other.back - placed.back).norm() > 0.3) return other;
    }
    return std::nullopt;
  }

  void take(const PlacedPiece& placed) {
    if (const auto footprint = footprint_of(placed)) room_.take(*footprint);
  }

 private:
  PieceKind any_of(const std::vector<PieceKind>& kinds) {
    return kinds[random_.below(static_cast<std::uint32_t>(kinds.size()))];
  }
  Piece new_piece(PieceKind kind) {
    const std::uint64_t high = random_.next();
    const std::uint64_t seed = (high << 32U) + random_.next();
    return {kind, seed, mix64(seed)};
  }

  void hide_walls(double share) {
    double perimeter = 0.0;
    const Ring& ring = room_.outline();
    for (std::size_t i = 0; i < ring.size(); ++i) perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
    double hidden = 0.0;
    for (int failures = 0; hidden < share * perimeter && failures < 40;) {
      const double width = try_wall(any_of(wall_pieces(room_.room().use)), 0.0);
      hidden += width;
      failures += width > 0.0 ? 0 : 1;
    }
  }

  /// The width of what was put there; 0: nothing.
  double try_wall(PieceKind kind, double height_m) {
    PlacedPiece placed{.piece = new_piece(kind), .height_m = height_m};
    const Vector3d size = size_of(placed.piece);
    for (int attempt = 0; attempt < 8; ++attempt) {
      if (!put_at_wall(placed, size)) continue;
      keep(placed);
      return size.x();
    }
    return 0.0;
  }

  void try_free(PieceKind kind) {
    PlacedPiece placed{.piece = new_piece(kind)};
    const Vector3d size = size_of(placed.piece);
    for (int attempt = 0; attempt < 12; ++attempt)
      if (put_free(placed, size)) return keep(placed);
  }

  void keep(const PlacedPiece& placed) {
    layout_.push_back(placed);
    take(placed);
  }

  bool put_at_wall(PlacedPiece& placed, const Vector3d& size) {
    const Ring& ring = room_.outline();
    const std::size_t i = random_.below(static_cast<std::uint32_t>(ring.size()));
    const Vector2d edge = ring[(i + 1) % ring.size()] - ring[i];
    const double free = edge.norm() - size.x() - 0.04;
    if (free < 0.0) return false;
    placed.along = edge.normalized();
    const double gap = on_wall(placed.piece.kind) ? 0.002 : random_.uniform(0.005, 0.06);
    placed.back = ring[i] + (0.02 + 0.5 * size.x() + random_.uniform() * free) * placed.along +
                  gap * left_of(placed.along);
    return room_.fits(area_of(placed, size), placed.height_m + size.z());
  }

  bool put_free(PlacedPiece& placed, const Vector3d& size) {
    const auto [low, high] = box_of(room_.outline());
    const double x = random_.uniform(low.x(), high.x());
    const double y = random_.uniform(low.y(), high.y());
    double turn = 0.0;
    if (random_.uniform() < 0.6) {
      turn = 1.5707963 * random_.below(4);
      turn += 0.05 * random_.normal();
    } else {
      turn = random_.uniform(0.0, 6.28);
    }
    placed.along = {std::cos(turn), std::sin(turn)};
    placed.back = {x, y};
    return room_.fits(area_of(placed, size), size.z());
  }

  DesignRoom room_;
  RandomStream& random_;
  Layout layout_;
};

bool loose(PieceKind kind) {
  return kind == PieceKind::small_object || kind == PieceKind::office_chair || kind == PieceKind::box_pile;
}

bool stands_at_wall(const PlacedPiece& placed, const Ring& outline) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d edge = (outline[(i + 1) % outline.size()] - outline[i]).normalized();
    if (edge.dot(placed.along) > 0.999 && std::abs(left_of(edge).dot(placed.back - outline[i])) < 0.1)
      return true;
  }
  return false;
}

}  // namespace

Layout make_fixtures(const World& world, std::size_t building, std::size_t room, std::uint64_t seed) {
  RandomStream random(seed, 11);
  const Building& home = world.buildings[building];
  const DesignRoom design(home, room);
  const double height = design.room().ceiling_m - design.room().floor_m;
  Layout fixtures;
  for (const TrueOpening& window : world.openings) {
    if (!window.exterior || window.kind != "window" ||
        window.rooms[0] != home.room_offset + static_cast<int>(room))
      continue;
    const Vector3d middle = 0.5 * (window.inner[0] + window.inner[1]);
    PlacedPiece radiator{.piece = {PieceKind::radiator, seed, seed}, .fixture = true};
    if (middle.z() - design.room().floor_m < size_of(radiator.piece).z() + 0.05) continue;
    const Vector2d in = -design.to_design(design.room().design_origin + Vector2d(window.normal.head<2>()));
    radiator.along = {in.y(), -in.x()};
    radiator.back = design.to_design(middle.head<2>()) + 0.03 * in;
    fixtures.push_back(radiator);
  }
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : design.outline()) middle += p / static_cast<double>(design.outline().size());
  const int lamps = 1 + static_cast<int>(signed_area(design.outline()) / 22.0);
  for (int i = 0; i < lamps; ++i) {
    PlacedPiece lamp{.piece = {PieceKind::ceiling_lamp, seed + 1, seed}, .fixture = true};
    const Vector2d corner =
        design.outline()[random.below(static_cast<std::uint32_t>(design.outline().size()))];
    lamp.back = middle + random.uniform(0.0, 0.5) * (corner - middle);
    lamp.height_m = height - size_of(lamp.piece).z();
    fixtures.push_back(lamp);
  }
  return fixtures;
}

Layout make_layout(const World& world, std::size_t building, std::size_t room, const LayoutOptions& options,
                   std::uint64_t seed) {
  RandomStream random(seed, 12);
  return LayoutDecorator(world, building, room, random).run(options);
}

Layout as_placed(const Layout& layout, const World& world, std::size_t building, std::size_t room,
                 const PlacingOptions& options, std::uint64_t seed) {
  RandomStream random(seed, 13);
  LayoutDecorator decorator(world, building, room, random);
  for (const PlacedPiece& placed : layout) decorator.take(placed);
  const Ring outline = DesignRoom(world.buildings[building], room).outline();
  Layout result;
  for (PlacedPiece placed : layout) {
    if (placed.fixture) {
      result.push_back(placed);
      continue;
    }
    if (random.uniform() < options.contents_share)
      placed.piece.contents_seed = mix64(placed.piece.contents_seed ^ seed);
    if (random.uniform() < options.removed_share) continue;
    if (random.uniform() < options.moved_share) {
      if (const auto other = decorator.elsewhere(placed, stands_at_wall(placed, outline))) {
        decorator.take(*other);
        result.push_back(*other);
        continue;
      }
    }
    if (!loose(placed.piece.kind) && random.uniform() >= options.pushed_share) {
      result.push_back(placed);
      continue;
    }
    const double much = loose(placed.piece.kind) ? 3.0 : 1.0;
    const double turn = on_wall(placed.piece.kind) ? 0.0 : much * options.turn_rad * random.normal();
    const Vector2d along = std::cos(turn) * placed.along + std::sin(turn) * left_of(placed.along);
    const double outward = much * options.shift_m * random.normal();
    const double sideways = much * options.shift_m * random.normal();
    placed.back += sideways * placed.along;
    // Nothing is pushed into the wall behind it.
    if (!on_wall(placed.piece.kind)) placed.back += std::abs(outward) * left_of(placed.along);
    placed.along = along;
    result.push_back(placed);
  }
  return result;
}

Layout as_put_up(Layout fixtures, double shift_m, std::uint64_t seed) {
  RandomStream random(seed, 14);
  for (PlacedPiece& placed : fixtures) {
    const double sideways = shift_m * random.normal();
    const double outward = shift_m * std::abs(random.normal());
    const double away = shift_m * std::abs(random.normal());
    placed.back += sideways * placed.along + outward * left_of(placed.along);
    placed.height_m += placed.height_m > 0.0 ? -away : away;
  }
  return fixtures;
}

void add_layout(World& world, std::size_t building, std::size_t room, const Layout& layout) {
  DesignRoom design(world.buildings[building], room);
  const Room here = design.room();
  const MeshMark begin = world.mesh.mark();
  for (const PlacedPiece& placed : layout) {
    const Vector3d size = size_of(placed.piece);
    const Ring area = area_of(placed, size);
    if (!placed.fixture && !design.fits(area, placed.height_m + size.z())) continue;
    if (placed.height_m + size.z() > here.ceiling_m - here.floor_m + 1e-9) continue;
    // A piece is no mirror image of itself: in a mirrored room it is at the mirrored place as it is.
    const Vector2d back = design.to_plan(placed.back);
    const Vector2d along = design.direction_to_plan(placed.along) * (design.mirrored() ? -1.0 : 1.0);
    add_piece(world.mesh, placed.piece, {{back.x(), back.y(), here.floor_m + placed.height_m}, along});
    if (const auto footprint = footprint_of(placed)) {
      design.take(*footprint);
      Footprint in_plan = *footprint;
      for (Vector2d& corner : in_plan.area) corner = design.to_plan(corner);
      if (design.mirrored()) std::reverse(in_plan.area.begin(), in_plan.area.end());
      world.buildings[building].occupied[room].push_back(in_plan);
    }
  }
  remember_furniture(world, building, room, begin);
}

}  // namespace limen
