// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/geometry/random_vectors.h"
#include "limen/simulate/furnishing/pieces.h"
#include "limen/simulate/model/bim_changes.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {
namespace {

constexpr double kFree = 0.8;       // m about a tripod
constexpr double kFarthestM = 8.0;  // of a wall from the station
constexpr double kGapM = 0.03;      // between a wall and what is before it
constexpr int kDirections = 72;
constexpr double kLeastAbove = 0.3;  // m of air above a piece

/// Puts boxes on floors that rays from a station find.
class Clutterer {
 public:
  Clutterer(BimMesh& built, const std::vector<BimStation>& stations, RandomStream& random)
      : built_(built), stations_(stations), random_(random), empty_(built.mesh), caster_(empty_) {}

  int fill(const BimStation& station, double per_m2) {
    const int wanted = std::clamp(static_cast<int>(std::lround(per_m2 * floor_area(station))), 1, 40);
    int placed = 0;
    for (int attempt = 0; attempt < 40 * wanted && placed < wanted; ++attempt)
      placed += place_piece(station) ? 1 : 0;
    return placed;
  }

  /// Puts large pieces along the walls that a ring of rays finds, until they hide that share of their length.
  int furnish_walls(const BimStation& station, double share) {
    double length = 0.0;
    std::vector<RayHit> walls;
    std::vector<Vector3d> feet;
    for (int i = 0; i < kDirections; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * (i + random_.uniform()) / kDirections;
      const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
      const RayHit hit = caster_.cast(station.position, direction);
      if (!hit.found() || hit.inside || hit.range_m > kFarthestM || !is_wall(hit)) continue;
      length += hit.range_m * 2.0 * std::numbers::pi / kDirections / std::max(0.2, hit.cosine);
      walls.push_back(hit);
      feet.emplace_back(station.position + hit.range_m * direction);
    }
    double wanted = share * length;
    int placed = 0;
    for (std::size_t attempt = 0; attempt < 6 * walls.size() && wanted > 0; ++attempt) {
      const std::size_t k = random_.below(static_cast<std::uint32_t>(walls.size()));
      const double width = place_before(walls[k], feet[k]);
      wanted -= width;
      placed += width > 0 ? 1 : 0;
    }
    return placed;
  }

 private:
  [[nodiscard]] bool is_wall(const RayHit& hit) const {
    const Surface& surface = built_.mesh.surfaces()[static_cast<std::size_t>(hit.surface)];
    return std::abs(surface.plane.normal.z()) < 0.05 && surface.element == Element::wall;
  }

  /// The width of the piece that was placed there, or 0.
  double place_before(const RayHit& wall, const Vector3d& at) {
    const Vector3d normal = built_.mesh.surfaces()[static_cast<std::size_t>(wall.surface)].plane.normal;
    const std::vector<PieceKind> kinds =
        wall_pieces(random_.uniform() < 0.6 ? RoomUse::living : RoomUse::office);
    const Piece piece{kinds[random_.below(static_cast<std::uint32_t>(kinds.size()))],
                      mix64(random_.below(1U << 30U)), mix64(random_.below(1U << 30U))};
    const Vector3d size = size_of(piece);
    const RayHit floor = caster_.cast(at + (kGapM + 0.5 * size.y()) * normal, -Vector3d::UnitZ());
    if (!floor.found() || floor.inside || floor.range_m > 2.2 || floor.range_m < 1.0) return 0.0;
    PiecePlace place;
    place.along = Vector2d(normal.y(), -normal.x());
    place.back = at + kGapM * normal;
    place.back.z() = at.z() - floor.range_m;
    const BoxPlace box{place.back + 0.5 * size.y() * normal, std::atan2(place.along.y(), place.along.x())};
    if (!fits(box, size, 0.5 * size.x())) return 0.0;
    add_piece(built_.mesh, piece, place);
    built_.element_of_surface.resize(built_.mesh.surfaces().size(), -1);
    pieces_.emplace_back(box.base, 0.5 * size.x());
    return size.x();
  }

  /// About: what a ring of rays at the station's height encloses.
  [[nodiscard]] double floor_area(const BimStation& station) const {
    Ring ring;
    for (int i = 0; i < 72; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / 72;
      const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
      const RayHit hit = caster_.cast(station.position, direction);
      const double range = hit.found() ? std::min(hit.range_m, 8.0) : 8.0;
      ring.emplace_back(range * direction.x(), range * direction.y());
    }
    return signed_area(ring);
  }

  bool place_piece(const BimStation& station) {
    const double azimuth = random_.uniform(0.0, 2.0 * std::numbers::pi);
    const double tilt = -random_.uniform(0.1, 1.0);
    const Vector3d direction(std::cos(tilt) * std::cos(azimuth), std::cos(tilt) * std::sin(azimuth),
                             std::sin(tilt));
    const RayHit hit = caster_.cast(station.position, direction);
    if (!hit.found() || hit.inside || hit.range_m > 12.0) return false;
    if (built_.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].plane.normal.z() < 0.999) return false;
    const Vector3d foot = station.position + hit.range_m * direction;
    if (station.position.z() - foot.z() < 1.2) return false;
    const bool large = random_.uniform() < 0.4;
    const Vector3d most = large ? Vector3d(1.8, 0.7, 2.0) : Vector3d(0.7, 0.6, 0.9);
    const Vector3d size = uniform_vector(Vector3d(0.3, 0.3, 0.3), most, random_);
    const BoxPlace place{foot, random_.uniform() < 0.7 ? heading_of_wall(foot) : random_.uniform(0.0, 3.1)};
    if (!fits(place, size, 0.5 * std::hypot(size.x(), size.y()))) return false;
    add(place, size);
    if (size.z() < 1.1 && random_.uniform() < 0.6) {
      const Vector3d small = {size.x() * random_.uniform(0.2, 0.6), size.y() * random_.uniform(0.2, 0.7),
                              random_.uniform(0.08, 0.4)};
      add({foot + Vector3d(0.0, 0.0, size.z()), place.yaw_rad}, small);
    }
    return true;
  }

  /// Along the nearest wall.
  [[nodiscard]] double heading_of_wall(const Vector3d& foot) const {
    double nearest = 1e300;
    double heading = 0.0;
    for (int i = 0; i < 16; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / 16;
      const RayHit hit =
          caster_.cast(foot + Vector3d(0.0, 0.0, 1.0), Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0));
      if (!hit.found() || hit.range_m >= nearest) continue;
      const Vector3d normal = built_.mesh.surfaces()[static_cast<std::size_t>(hit.surface)].plane.normal;
      if (std::abs(normal.z()) > 0.3) continue;
      nearest = hit.range_m;
      heading = std::atan2(normal.x(), -normal.y());
    }
    return heading;
  }

  /// Clear of walls, of tripods and of the other pieces, from which it keeps `reach`.
  [[nodiscard]] bool fits(const BoxPlace& place, const Vector3d& size, double reach) const {
    for (const BimStation& station : stations_) {
      const Vector3d apart = station.position - place.base;
      if (std::abs(apart.z()) < 2.5 && apart.head<2>().norm() < reach + kFree) return false;
    }
    for (const auto& [base, other] : pieces_)
      if ((base - place.base).head<2>().norm() < reach + other) return false;
    for (const double height : {0.05, 0.5, 0.98}) {
      const Vector3d middle = place.base + Vector3d(0.0, 0.0, height * size.z());
      for (int i = 0; i < 16; ++i) {
        const double azimuth = place.yaw_rad + 2.0 * std::numbers::pi * i / 16;
        const double x = std::abs(std::cos(2.0 * std::numbers::pi * i / 16)) / (0.5 * size.x());
        const double y = std::abs(std::sin(2.0 * std::numbers::pi * i / 16)) / (0.5 * size.y());
        const RayHit hit = caster_.cast(middle, Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0));
        if (hit.found() && (hit.inside || hit.range_m < 1.0 / std::max(x, y) + 0.02)) return false;
      }
    }
    const RayHit up = caster_.cast(place.base, Vector3d::UnitZ(), 1e-3);
    return !up.found() || up.range_m > size.z() + kLeastAbove;
  }

  void add(const BoxPlace& place, const Vector3d& size) {
    Surface wood = surface_of(Element::furniture);
    wood.reflectivity = random_.uniform(0.2, 0.75);
    built_.mesh.add_box(place, size, wood);
    built_.element_of_surface.resize(built_.mesh.surfaces().size(), -1);
    pieces_.emplace_back(place.base, 0.5 * std::hypot(size.x(), size.y()));
  }

  BimMesh& built_;
  const std::vector<BimStation>& stations_;
  RandomStream& random_;
  Mesh empty_;  ///< the building without the boxes: a caster's mesh must not grow
  RayCaster caster_;
  std::vector<std::pair<Vector3d, double>> pieces_;
};

}  // namespace

int add_clutter(BimMesh& built, const std::vector<BimStation>& stations, const AsBuiltOptions& options,
                RandomStream& random) {
  if (options.furniture_per_m2 <= 0.0 && options.hidden_wall_share <= 0.0) return 0;
  Clutterer clutterer(built, stations, random);
  std::vector<int> filled;
  int count = 0;
  for (const BimStation& station : stations) {
    // One filling per room; of places in no named room, the first.
    if (std::find(filled.begin(), filled.end(), station.room) != filled.end()) continue;
    filled.push_back(station.room);
    if (options.hidden_wall_share > 0.0) count += clutterer.furnish_walls(station, options.hidden_wall_share);
    if (options.furniture_per_m2 > 0.0) count += clutterer.fill(station, options.furniture_per_m2);
  }
  return count;
}

}  // namespace limen
