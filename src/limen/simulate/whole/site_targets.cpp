// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/site_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {
namespace {

constexpr double kPoleM = 0.02;     // thick
constexpr double kOffWallM = 0.01;  // walls as built bulge
constexpr double kTargetsApartM = 0.8;
constexpr double kRoomM = 0.25;

bool apart(const Vector3d& x, const std::vector<SiteTarget>& others) {
  return std::all_of(others.begin(), others.end(),
                     [&](const SiteTarget& other) { return (other.centre - x).norm() > kTargetsApartM; });
}

/// Looks for places of targets in one room, and puts them up.
class RoomTargets {
 public:
  RoomTargets(WholeBuilding& building, const RayCaster& caster, std::size_t room)
      : building_(building.world.buildings[0]), mesh_(building.world.mesh), caster_(caster), room_(room) {}

  std::optional<Vector3d> sphere(const std::vector<SiteTarget>& others, RandomStream& random) {
    for (int attempt = 0; attempt < 200; ++attempt) {
      const Vector3d centre = place(random.uniform(1.0, 1.9), random);
      if (!is_free(building_, room_, centre.head<2>(), 0.3) || !has_room_for_sphere(caster_, centre, others))
        continue;
      add_sphere_on_pole(mesh_, centre, building_.floor_height(room_, centre.head<2>()));
      return centre;
    }
    return std::nullopt;
  }

  std::optional<Vector3d> board(const std::vector<SiteTarget>& others, RandomStream& random) {
    for (int attempt = 0; attempt < 200; ++attempt) {
      const Vector3d from = place(random.uniform(1.2, 1.9), random);
      const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
      const RayHit hit = caster_.cast(from, {std::cos(azimuth), std::sin(azimuth), 0.0});
      if (!hit.found() || hit.inside || hit.range_m > 15.0) continue;
      const Surface& wall = caster_.mesh().surfaces()[static_cast<std::size_t>(hit.surface)];
      if (wall.element != Element::wall) continue;
      const Vector3d on_wall = from + hit.range_m * Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
      const PlaneFrame frame = make_frame(wall.plane, on_wall + kOffWallM * wall.plane.normal);
      const PlaneFrame hung{on_wall + kOffWallM * wall.plane.normal, frame.u, frame.v};
      if (!apart(hung.origin, others) || !bare(hung, wall.plane.normal, hit.surface)) continue;
      add_board(mesh_, hung);
      return hung.origin;
    }
    return std::nullopt;
  }

 private:
  Vector3d place(double height_m, RandomStream& random) const {
    const Room& room = building_.plan.rooms[room_];
    const auto [low, high] = box_of(room.outline);
    const Vector2d p = uniform_vector(low, high, random);
    return {p.x(), p.y(), room.floor_m + height_m};
  }

  /// Whether the wall behind the board and round it is free.
  [[nodiscard]] bool bare(const PlaneFrame& frame, const Vector3d& normal, int wall) const {
    for (int k = 0; k < 16; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / 16;
      const Vector3d before =
          frame.to_space(0.8 * kBoardSideM * Vector2d(std::cos(turn), std::sin(turn))) + 0.4 * normal;
      const RayHit hit = caster_.cast(before, -normal);
      if (hit.surface != wall || hit.range_m < 0.35) return false;
    }
    return true;
  }

  const Building& building_;
  Mesh& mesh_;
  const RayCaster& caster_;
  std::size_t room_;
};

}  // namespace

void add_board(Mesh& mesh, const PlaneFrame& frame, double side_m) {
  for (const Vector2d& corner : {Vector2d(-1, -1), Vector2d(0, -1), Vector2d(-1, 0), Vector2d(0, 0)}) {
    Surface paper = surface_of(Element::furniture);
    paper.planar = false;
    paper.reflectivity = corner.x() == corner.y() ? 0.85 : 0.06;
    std::vector<Vector3d> ring;
    for (const Vector2d& way : {Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1), Vector2d(0, 1)})
      ring.push_back(frame.to_space(0.5 * side_m * (corner + way)));
    mesh.add_polygon(ring, paper);
  }
}

void add_sphere(Mesh& mesh, const Vector3d& centre, double radius_m) {
  Surface paint = surface_of(Element::furniture);
  paint.reflectivity = 0.8;
  mesh.add_ball({centre, radius_m}, paint);
}

void add_sphere_on_pole(Mesh& mesh, const Vector3d& centre, double floor_m) {
  add_sphere(mesh, centre);
  mesh.add_box({Vector3d(centre.x(), centre.y(), floor_m), 0.0},
               {kPoleM, kPoleM, centre.z() - kSphereRadiusM - floor_m}, surface_of(Element::furniture));
}

bool has_room_for_sphere(const RayCaster& caster, const Vector3d& centre,
                         const std::vector<SiteTarget>& others) {
  if (!apart(centre, others)) return false;
  for (int k = 0; k < 60; ++k) {
    const double z = 1.0 - (k + 0.5) / 30.0;
    const double turn = 2.4 * k;
    const double flat = std::sqrt(1.0 - z * z);
    const RayHit hit = caster.cast(centre, {flat * std::cos(turn), flat * std::sin(turn), z});
    if (hit.found() && (hit.inside || hit.range_m < kRoomM)) return false;
  }
  return true;
}

std::vector<SiteTarget> put_up_targets(WholeBuilding& building, std::size_t count, std::uint64_t seed) {
  std::vector<SiteTarget> targets;
  if (count == 0) return targets;
  const Mesh bare = building.world.mesh;
  const RayCaster caster(bare);
  std::set<std::size_t> rooms;
  for (const StationWish& wish : building.wishes) rooms.insert(wish.room);
  for (const std::size_t room : rooms) {
    RandomStream random(seed, 400000 + room);
    RoomTargets here(building, caster, room);
    for (std::size_t k = 0; k < count; ++k) {
      const std::optional<Vector3d> centre =
          k % 2 == 0 ? here.sphere(targets, random) : here.board(targets, random);
      if (centre)
        targets.push_back({fmt::format("{}{}", k % 2 == 0 ? "S" : "B", targets.size() + 1), *centre});
    }
  }
  return targets;
}

}  // namespace limen
