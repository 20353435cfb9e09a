// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/survey.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/buildings/building.h"

namespace limen {
namespace {

/// Looks for a place in one room: the plan proposes, rays dispose.
class RoomSurvey {
 public:
  RoomSurvey(const WholeBuilding& building, const RayCaster& caster, const StationWish& wish,
             RandomStream& random)
      : building_(building.world.buildings[0]),
        caster_(caster),
        wish_(wish),
        room_(building_.plan.rooms[wish.room]),
        random_(random) {}

  std::optional<StationPlace> run(const World& world) {
    if (wish_.doorway >= 0) return in_doorway(world.openings[static_cast<std::size_t>(wish_.doorway)]);
    std::optional<StationPlace> best;
    int most = -1;
    int found = 0;
    for (const double radius : {0.6, 0.45, 0.3, 0.22}) {
      for (int attempt = 0; attempt < 250 && found < 16; ++attempt) {
        const Vector3d place = random_place();
        if (!clear(place, radius)) continue;
        ++found;
        const int seen = rays_out(place);
        if (seen <= most) continue;
        most = seen;
        best = StationPlace{place, wish_.room};
      }
      if (best) return best;
    }
    return best;
  }

 private:
  /// In the middle of the doorway, a little towards its room: the plane half way through the wall is counted.
  std::optional<StationPlace> in_doorway(const TrueOpening& door) {
    const Vector3d sill = 0.25 * (door.outer[0] + door.outer[1] + door.inner[0] + door.inner[1]);
    const Vector3d place = sill - 0.04 * door.normal + Vector3d(0.0, 0.0, random_.uniform(1.4, 1.7));
    if (nearest(place) < 0.2) return std::nullopt;
    return StationPlace{place, wish_.room};
  }

  Vector3d random_place() {
    const auto [low, high] = box_of(room_.outline);
    Vector2d share = uniform_vector(Vector2d(0.0, 0.0), Vector2d(1.0, 1.0), random_);
    const Eigen::Index longer = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    share[longer] = wish_.from + (wish_.to - wish_.from) * share[longer];
    const Vector2d p = low + share.cwiseProduct(high - low);
    return {p.x(), p.y(), room_.floor_m + random_.uniform(1.4, 1.7)};
  }

  /// Of rays in all directions those that leave the room through a doorway, or a staircase up or down its
  /// well.
  [[nodiscard]] int rays_out(const Vector3d& from) const {
    constexpr int kRays = 800;
    int out = 0;
    for (int i = 0; i < kRays; ++i) {
      const double z = 1.0 - 2.0 * (i + 0.5) / kRays;
      const double flat = std::sqrt(1.0 - z * z);
      const Vector3d direction(flat * std::cos(2.399963 * i), flat * std::sin(2.399963 * i), z);
      out += doorways_passed(from, direction);
      out += room_.use == RoomUse::stairs && leaves_the_storey(from, direction) ? 1 : 0;
    }
    return out;
  }

  [[nodiscard]] bool leaves_the_storey(const Vector3d& from, const Vector3d& direction) const {
    const RayHit hit = caster_.cast(from, direction);
    if (!hit.found()) return false;
    const double height = from.z() + direction.z() * hit.range_m;
    return height > room_.ceiling_m + 0.1 || height < room_.floor_m - 0.1;
  }

  /// How many doorways a ray passes before it ends on a surface: through two in a row is better than through
  /// one.
  [[nodiscard]] int doorways_passed(const Vector3d& from, const Vector3d& direction) const {
    double begin = 0.0;
    for (int passed = 0; passed < 3; ++passed) {
      const RayHit hit = caster_.cast(from, direction, begin);
      if (!hit.found()) return passed;
      const Element element = caster_.mesh().surfaces()[static_cast<std::size_t>(hit.surface)].element;
      if (element != Element::portal) return passed;
      begin = hit.range_m + 1e-3;
    }
    return 3;
  }

  [[nodiscard]] bool clear(const Vector3d& p, double radius) const {
    // In small rooms the only free floor is what doors swing over: they stand open while somebody scans.
    const bool small = radius < 0.4;
    if (small ? !contains(room_.outline, Vector2d(p.head<2>()))
              : !is_free(building_, wish_.room, {p.x(), p.y()}, radius))
      return false;
    const RayHit down = caster_.cast(p, -Vector3d::UnitZ());
    if (!down.found() ||
        std::abs(p.z() - down.range_m - building_.floor_height(wish_.room, p.head<2>())) > 0.01)
      return false;
    return nearest(p) >= radius;
  }

  [[nodiscard]] bool is_portal(const RayHit& hit) const {
    return hit.found() &&
           caster_.mesh().surfaces()[static_cast<std::size_t>(hit.surface)].element == Element::portal;
  }

  /// How near the nearest solid is, in plan; 0 where the place lies within one.
  [[nodiscard]] double nearest(const Vector3d& p) const {
    double least = 1e9;
    for (const double tilt : {-0.8, -0.3, 0.0, 0.4}) {
      for (int i = 0; i < 24; ++i) {
        const double azimuth = 2.0 * std::numbers::pi * i / 24;
        const Vector3d direction(std::cos(tilt) * std::cos(azimuth), std::cos(tilt) * std::sin(azimuth),
                                 std::sin(tilt));
        RayHit hit = caster_.cast(p, direction);
        // Who is in a doorway has its empty cross-section beside him: it is no solid.
        for (int step = 0; wish_.doorway >= 0 && step < 4 && is_portal(hit); ++step)
          hit = caster_.cast(p, direction, hit.range_m + 1e-3);
        if (!hit.found()) continue;
        if (hit.inside) return 0.0;
        least = std::min(least, hit.range_m * std::cos(tilt));
      }
    }
    return least;
  }

  const Building& building_;
  const RayCaster& caster_;
  const StationWish& wish_;
  const Room& room_;
  RandomStream& random_;
};

}  // namespace

std::optional<StationPlace> survey(const WholeBuilding& building, const RayCaster& caster,
                                   const StationWish& wish, std::uint64_t seed) {
  if (wish.doorway >= 0) {
    RandomStream doorway(seed, 300000 + static_cast<std::uint64_t>(wish.doorway));
    return RoomSurvey(building, caster, wish, doorway).run(building.world);
  }
  RandomStream random(seed,
                      100000 + 64 * wish.room + static_cast<std::uint64_t>(std::lround(60.0 * wish.from)));
  return RoomSurvey(building, caster, wish, random).run(building.world);
}

std::optional<StationPlace> survey_street(const WholeBuilding& building, const RayCaster& caster,
                                          std::size_t number, std::size_t count, std::uint64_t seed) {
  const Ring& envelope = building.world.buildings[0].plan.envelope;
  const std::size_t n = envelope.size();
  double length = 0.0;
  for (std::size_t i = 0; i < n; ++i) length += (envelope[(i + 1) % n] - envelope[i]).norm();
  RandomStream random(seed, 200000 + number);
  for (int attempt = 0; attempt < 60; ++attempt) {
    // Even shares of the way round, and about there; farther along where something is in the way.
    const double share = (static_cast<double>(number) + 0.5) / static_cast<double>(count);
    double along = std::fmod(share * length + random.uniform(-0.05, 0.05) * attempt + length, length);
    const double distance = random.uniform(4.0, 7.0);
    for (std::size_t i = 0; i < n; ++i) {
      const Vector2d side = envelope[(i + 1) % n] - envelope[i];
      if (along > side.norm()) {
        along -= side.norm();
        continue;
      }
      const Vector2d way = side.normalized();
      const Vector2d at = envelope[i] + along * way + distance * Vector2d(way.y(), -way.x());
      if (const auto place = tripod_on_ground(caster, at, random.uniform(1.5, 1.8)))
        return StationPlace{*place, kStreet};
      break;
    }
  }
  return std::nullopt;
}

}  // namespace limen
