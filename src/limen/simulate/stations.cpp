// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/stations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/simulate/buildings/building.h"

namespace limen {
namespace {

/// Finds places by trial: the building's plan proposes, rays dispose.
class Surveyor {
 public:
  Surveyor(const Recipe& recipe, const RayCaster& caster, RandomStream& random)
      : building_(recipe.world.buildings[0]), world_(recipe.world), caster_(caster), random_(random) {}

  [[nodiscard]] std::optional<Station> in_room(std::size_t room, const std::vector<Station>& others) {
    for (const double radius : {0.6, 0.45, 0.3}) {
      for (int attempt = 0; attempt < 300; ++attempt) {
        const Station station{random_point(room), room};
        const bool apart = std::all_of(others.begin(), others.end(), [&](const Station& other) {
          return (other.position - station.position).norm() > (attempt < 200 ? 1.2 : 0.5);
        });
        if (apart && clear(station, radius)) return station;
      }
    }
    return std::nullopt;
  }

  /// Of several free places the one that sees most of the street through the room's windows.
  [[nodiscard]] std::optional<Station> with_a_view(std::size_t room, const std::vector<Station>& others) {
    std::optional<Station> best;
    int most = -1;
    for (int attempt = 0; attempt < 10; ++attempt) {
      const std::optional<Station> station = in_room(room, others);
      const int seen = station ? windows_seen(*station) : -1;
      if (seen <= most) continue;
      most = seen;
      best = station;
    }
    return best;
  }

  /// Two stations on either side of one open door, in sight.
  [[nodiscard]] std::vector<Station> through_a_door() {
    std::vector<std::size_t> doors;
    for (std::size_t i = 0; i < world_.openings.size(); ++i)
      if (!world_.openings[i].exterior && !world_.openings[i].curtained) doors.push_back(i);
    for (int attempt = 0; attempt < 20000 && !doors.empty(); ++attempt) {
      const TrueOpening& door =
          world_.openings[doors[random_.below(static_cast<std::uint32_t>(doors.size()))]];
      const auto inner = static_cast<std::size_t>(door.rooms[0]);
      const auto outer = static_cast<std::size_t>(door.rooms[1]);
      if (small(inner) || small(outer)) continue;
      const Station first{random_point(inner), inner};
      const Station second{beyond(first.position, door, outer), outer};
      if (clear(first, 0.4) && clear(second, 0.4) && in_sight(first.position, second.position))
        return {first, second};
    }
    return {};
  }

  /// Of places before the windows of a station's room the one that sees most of them.
  [[nodiscard]] std::optional<Station> before_windows(const Station& inside) {
    std::vector<const TrueOpening*> windows;
    for (const TrueOpening& window : world_.openings)
      if (window.exterior && window.glazed && window.rooms[0] == static_cast<int>(inside.room))
        windows.push_back(&window);
    std::optional<Station> best;
    int most = -1;
    for (int attempt = 0; attempt < 400 && !windows.empty(); ++attempt) {
      const TrueOpening& window = *windows[random_.below(static_cast<std::uint32_t>(windows.size()))];
      const Vector3d along = (window.outer[1] - window.outer[0]).normalized();
      const Vector3d at = 0.5 * (window.outer[0] + window.outer[1]) + random_.uniform(-5.0, 5.0) * along +
                          random_.uniform(3.0, 9.0) * window.normal;
      const auto place = tripod_on_ground(caster_, at.head<2>(), random_.uniform(1.5, 1.8));
      const int seen = place ? windows_seen({*place, inside.room}) : -1;
      if (seen <= most) continue;
      most = seen;
      best = Station{*place, kStreet};
    }
    return best;
  }

 private:
  [[nodiscard]] bool small(std::size_t room) const {
    return signed_area(building_.plan.rooms[room].outline) < 7.0;
  }

  Vector3d random_point(std::size_t room) {
    const Room& r = building_.plan.rooms[room];
    const auto [low, high] = box_of(r.outline);
    const double x = random_.uniform(low.x(), high.x());
    const double y = random_.uniform(low.y(), high.y());
    return {x, y, r.floor_m + random_.uniform(1.35, 1.75)};
  }

  /// How many of 5 x 5 points in each of the room's open windows on a street can be seen past.
  [[nodiscard]] int windows_seen(const Station& station) const {
    int seen = 0;
    for (const TrueOpening& window : world_.openings) {
      if (!window.exterior || window.curtained || window.rooms[0] != static_cast<int>(station.room)) continue;
      const bool street =
          std::any_of(building_.street_normals.begin(), building_.street_normals.end(),
                      [&](const Vector2d& n) { return n.dot(window.normal.head<2>()) > 0.999; });
      for (int i = 0; street && i < 25; ++i) {
        const int row = i / 5;
        const Vector3d u = (i % 5 + 0.5) / 5.0 * (window.outer[1] - window.outer[0]);
        const Vector3d v = (row + 0.5) / 5.0 * (window.outer[3] - window.outer[0]);
        seen += in_sight(station.position, window.outer[0] + u + v) ? 1 : 0;
      }
    }
    return seen;
  }

  /// A point of `room` on a line from `from` through the doorway.
  Vector3d beyond(const Vector3d& from, const TrueOpening& door, std::size_t room) {
    const Vector3d across = door.outer[1] - door.outer[0];
    const Vector3d gap = door.outer[0] + random_.uniform(0.2, 0.8) * across;
    Vector3d p = gap + (gap - from).normalized() * random_.uniform(0.5, 5.0);
    p.z() = building_.plan.rooms[room].floor_m + random_.uniform(1.35, 1.75);
    return p;
  }

  /// Stands on the floor with nothing within `radius`.
  [[nodiscard]] bool clear(const Station& station, double radius) const {
    const Vector3d& p = station.position;
    if (!is_free(building_, station.room, {p.x(), p.y()}, radius)) return false;
    const RayHit down = caster_.cast(p, -Vector3d::UnitZ());
    if (!down.found() ||
        std::abs(p.z() - down.range_m - building_.floor_height(station.room, p.head<2>())) > 0.01)
      return false;
    for (const double tilt : {-0.8, -0.3, 0.0, 0.4}) {
      for (int i = 0; i < 24; ++i) {
        const double azimuth = 2.0 * std::numbers::pi * i / 24;
        const Vector3d direction(std::cos(tilt) * std::cos(azimuth), std::cos(tilt) * std::sin(azimuth),
                                 std::sin(tilt));
        const RayHit hit = caster_.cast(p, direction);
        if (hit.found() && (hit.inside || hit.range_m * std::cos(tilt) < radius)) return false;
      }
    }
    return true;
  }

  /// Nothing but open doorways and panes in between.
  [[nodiscard]] bool in_sight(const Vector3d& from, const Vector3d& to) const {
    const double distance = (to - from).norm();
    const Vector3d direction = (to - from) / distance;
    double start = 0.0;
    for (int step = 0; step < 6; ++step) {
      const RayHit hit = caster_.cast(from, direction, start);
      if (!hit.found() || hit.range_m > distance) return true;
      const Surface& surface = caster_.mesh().surfaces()[static_cast<std::size_t>(hit.surface)];
      if (surface.element != Element::portal && surface.element != Element::glass) return false;
      start = hit.range_m + 1e-3;
    }
    return false;
  }

  const Building& building_;
  const World& world_;
  const RayCaster& caster_;
  RandomStream& random_;
};

}  // namespace

std::vector<Station> place_stations(const Recipe& recipe, const RayCaster& caster, RandomStream& random) {
  Surveyor surveyor(recipe, caster, random);
  std::vector<Station> stations;
  if (recipe.through_door) stations = surveyor.through_a_door();
  for (std::size_t i = stations.size(); i < recipe.station_rooms.size(); ++i) {
    // A room may be too full: then one as good does, or any other.
    std::vector<std::size_t> rooms = {recipe.station_rooms[i]};
    if (i == 0) rooms.insert(rooms.end(), recipe.spare_rooms.begin(), recipe.spare_rooms.end());
    for (std::size_t room = 0; room < recipe.world.buildings[0].plan.rooms.size(); ++room)
      rooms.push_back(room);
    std::optional<Station> station;
    for (std::size_t k = 0; !station && k < rooms.size(); ++k)
      station =
          recipe.wants_view ? surveyor.with_a_view(rooms[k], stations) : surveyor.in_room(rooms[k], stations);
    if (!station)
      throw Error("no room of the simulated building has space for a scanner", "limen simulate",
                  "choose another --seed", Fault::internal);
    stations.push_back(*station);
  }
  return stations;
}

std::optional<Vector3d> tripod_on_ground(const RayCaster& caster, const Vector2d& at, double height_m) {
  constexpr double kHigh = 60.0;
  // Seen from the sky there is nothing above it but the ground.
  const RayHit down = caster.cast({at.x(), at.y(), kHigh}, -Vector3d::UnitZ());
  if (!down.found() || down.inside) return std::nullopt;
  const Element below = caster.mesh().surfaces()[static_cast<std::size_t>(down.surface)].element;
  if (below != Element::ground && below != Element::pavement) return std::nullopt;
  const Vector3d place(at.x(), at.y(), kHigh - down.range_m + height_m);
  for (const double tilt : {-0.8, -0.3, 0.0, 0.4}) {
    for (int i = 0; i < 24; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / 24;
      const RayHit hit = caster.cast(
          place, {std::cos(tilt) * std::cos(azimuth), std::cos(tilt) * std::sin(azimuth), std::sin(tilt)});
      if (hit.found() && hit.range_m * std::cos(tilt) < 0.5) return std::nullopt;
    }
  }
  return place;
}

Station place_in_street(const Recipe& recipe, const RayCaster& caster, const Station& inside,
                        RandomStream& random) {
  const std::optional<Station> place = Surveyor(recipe, caster, random).before_windows(inside);
  if (place) return *place;
  throw Error("there is no place for a tripod before the windows of the room", "limen simulate",
              "choose another --seed, or a scene with a street");
}

}  // namespace limen
