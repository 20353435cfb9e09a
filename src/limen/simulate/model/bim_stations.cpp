// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_stations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kSameLength = 0.05;  // m
constexpr double kNearWall = 0.6;     // m: an opening's middle from the room it belongs to

bool same(double a, double b) {
  return std::abs(a - b) <= kSameLength;
}

/// The plan: what the space's bottom covers.
std::vector<Polygon> plan_of(const BimSpace& space) {
  const PlaneFrame ground;
  std::vector<Polygon> parts;
  for (const BimFace& face : space.faces) {
    if (face.plane.normal.z() > -0.5) continue;
    for (Polygon& part : projected({face.outline}, face.frame, ground)) parts.push_back(std::move(part));
  }
  return merged(parts);
}

/// Sides of the smallest rectangle round the plan with a side along one of its edges: longer, shorter.
Vector2d smallest_rectangle(const std::vector<Polygon>& plan) {
  Vector2d best(0.0, 0.0);
  double least = 1e300;
  for (const Polygon& part : plan) {
    for (std::size_t i = 0; i < part.outer.size(); ++i) {
      const Vector2d edge = part.outer[(i + 1) % part.outer.size()] - part.outer[i];
      if (edge.norm() < 1e-6) continue;
      const Vector2d along = edge.normalized();
      Box2 box;
      for (const Polygon& other : plan)
        for (const Vector2d& p : other.outer) box.add({along.dot(p), along.x() * p.y() - along.y() * p.x()});
      const Vector2d size = box.high - box.low;
      if (size.prod() >= least) continue;
      least = size.prod();
      best = {size.maxCoeff(), size.minCoeff()};
    }
  }
  return best;
}

std::vector<Vector3d> openings_of(const BimModel& model, const BimRoom& room) {
  const std::vector<Polygon> reach = grown(room.outline, kNearWall);
  std::vector<Vector3d> openings;
  for (const BimOpening& opening : model.openings) {
    const Vector3d middle =
        0.25 * (opening.corners[0] + opening.corners[1] + opening.corners[2] + opening.corners[3]) -
        0.5 * opening.thickness_m * opening.normal;
    const double up = middle.z() - room.floor_m;
    if (std::abs(opening.normal.z()) > 0.3 || up < 0.0 || up > room.height_m) continue;
    const Vector2d at = middle.head<2>();
    if (std::none_of(reach.begin(), reach.end(), [&](const Polygon& p) { return contains(p, at); })) continue;
    openings.emplace_back((opening.corners[1] - opening.corners[0]).norm(),
                          (opening.corners[3] - opening.corners[0]).norm(),
                          std::min(opening.corners[0].z(), opening.corners[3].z()) - room.floor_m);
  }
  // Sizes in steps of 1 mm: the digits behind must not decide the order.
  const auto key = [](const Vector3d& o) {
    return std::tuple(std::lround(1e3 * o.x()), std::lround(1e3 * o.y()), std::lround(1e3 * o.z()));
  };
  std::sort(openings.begin(), openings.end(),
            [&](const Vector3d& a, const Vector3d& b) { return key(a) < key(b); });
  return openings;
}

}  // namespace

std::vector<BimRoom> rooms_of(const BimModel& model) {
  std::vector<BimRoom> rooms;
  for (std::size_t i = 0; i < model.spaces.size(); ++i) {
    BimRoom room;
    room.space = static_cast<int>(i);
    room.outline = plan_of(model.spaces[i]);
    room.area_m2 = area(room.outline);
    if (room.area_m2 < 0.1) continue;
    double low = 1e300;
    double high = -1e300;
    for (const BimFace& face : model.spaces[i].faces) {
      for (const Vector2d& p : face.outline.outer) {
        low = std::min(low, face.frame.to_space(p).z());
        high = std::max(high, face.frame.to_space(p).z());
      }
    }
    room.floor_m = low;
    room.height_m = high - low;
    const Vector2d size = smallest_rectangle(room.outline);
    room.length_m = size.x();
    room.width_m = size.y();
    room.openings = openings_of(model, room);
    rooms.push_back(std::move(room));
  }
  return rooms;
}

bool alike(const BimRoom& a, const BimRoom& b) {
  if (!same(a.length_m, b.length_m) || !same(a.width_m, b.width_m) || !same(a.height_m, b.height_m))
    return false;
  if (std::abs(a.area_m2 - b.area_m2) > kSameLength * (a.length_m + a.width_m)) return false;
  if (a.openings.size() != b.openings.size()) return false;
  for (std::size_t i = 0; i < a.openings.size(); ++i)
    if ((a.openings[i] - b.openings[i]).cwiseAbs().maxCoeff() > kSameLength) return false;
  return true;
}

ModelRoom describe(const BimModel& model, const std::vector<BimRoom>& rooms, std::size_t room) {
  const BimRoom& own = rooms[room];
  const BimSpace& space = model.spaces[static_cast<std::size_t>(own.space)];
  ModelRoom stated;
  stated.space = own.space;
  stated.guid = space.guid;
  stated.name = space.name;
  stated.length_m = own.length_m;
  stated.width_m = own.width_m;
  stated.height_m = own.height_m;
  stated.area_m2 = own.area_m2;
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (i != room && alike(own, rooms[i])) stated.like.push_back(rooms[i].space);
  return stated;
}

namespace {

constexpr double kLeastArea = 5.0;       // m^2
constexpr double kLeastAreaOfAll = 2.0;  // m^2, where all rooms are scanned
constexpr double kLeastHeight = 2.0;     // m
constexpr double kClearance = 0.5;       // m
constexpr double kDoorwayClearance = 0.3;
constexpr double kBetween = 1.0;          // m, from one station to the next
constexpr double kHighestCeiling = 12.0;  // m above the scanner
constexpr int kRays = 128;
constexpr double kEnclosed = 0.75;  ///< share of the rays that must end somewhere; in a named room
constexpr double kEnclosedUnnamed = 0.95;
constexpr double kFarthestWall = 25.0;  // m, where no room is named

/// Finds places by trial: rays dispose.
class BimSurveyor {
 public:
  BimSurveyor(const std::vector<BimRoom>& rooms, const RayCaster& caster, RandomStream& random)
      : rooms_(rooms), caster_(caster), random_(random), directions_(spread_directions(kRays)) {
    for (const Vector3d& vertex : caster.mesh().vertices()) {
      low_ = low_.cwiseMin(vertex);
      high_ = high_.cwiseMax(vertex);
    }
  }

  [[nodiscard]] std::optional<BimStation> first(RoomChoice choice) {
    if (rooms_.empty()) return anywhere();
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < rooms_.size(); ++i)
      if (rooms_[i].area_m2 >= kLeastArea && rooms_[i].height_m >= kLeastHeight && is_chosen(i, choice))
        order.push_back(i);
    // Shuffled: another seed scans another room.
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random_.below(static_cast<std::uint32_t>(i))]);
    for (const std::size_t room : order)
      if (std::optional<BimStation> station = in_room(room)) return station;
    return choice == RoomChoice::any ? anywhere() : std::nullopt;
  }

  /// One in each room that has space for it, in the order of the model; then a second one, and so on.
  [[nodiscard]] std::vector<BimStation> through_all(std::vector<BimStation> stations, std::size_t count) {
    for (std::size_t before = stations.size(); stations.size() < count;) {
      for (std::size_t room = 0; room < rooms_.size() && stations.size() < count; ++room) {
        if (rooms_[room].area_m2 < kLeastAreaOfAll || rooms_[room].height_m < kLeastHeight) continue;
        const std::optional<BimStation> station = in_room(room);
        if (station && are_apart(stations, *station)) stations.push_back(*station);
      }
      if (stations.size() == before) break;
      before = stations.size();
    }
    return stations;
  }

  /// In the open doorways between two rooms of the lowest storey, in the order of the model.
  [[nodiscard]] std::vector<BimStation> in_doorways(const std::vector<BimOpening>& openings,
                                                    std::size_t count) {
    std::vector<BimStation> stations;
    double ground = 1e300;
    for (const BimRoom& room : rooms_) ground = std::min(ground, room.floor_m);
    for (const BimOpening& opening : openings) {
      if (stations.size() == count) break;
      const Vector3d foot =
          0.5 * (opening.corners[0] + opening.corners[1]) - 0.5 * opening.thickness_m * opening.normal;
      const Vector3d knee = foot + Vector3d(0.0, 0.0, 0.5);
      const Vector3d beyond = (0.5 * opening.thickness_m + 0.3) * opening.normal;
      if (foot.z() > ground + 1.0 || room_at(knee + beyond) < 0 || room_at(knee - beyond) < 0) continue;
      const auto place = on_floor(knee);
      if (place && clear(*place, kEnclosed, kDoorwayClearance))
        stations.push_back(BimStation{*place, room_at(*place)});
    }
    return stations;
  }

  /// Another one in sight of the first.
  [[nodiscard]] std::optional<BimStation> next(const std::vector<BimStation>& others) {
    const bool elsewhere = random_.uniform() < 0.5;
    for (int attempt = 0; attempt < 3000; ++attempt) {
      const std::optional<BimStation> station = in_sight_of(others.front());
      if (!station) continue;
      // A room seen through a door is asked for; where there is none, the same room will do.
      if (elsewhere && attempt < 1500 && station->room == others.front().room) continue;
      if (are_apart(others, *station)) return station;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] static bool are_apart(const std::vector<BimStation>& others, const BimStation& station) {
    return std::all_of(others.begin(), others.end(), [&](const BimStation& other) {
      return (other.position - station.position).norm() >= kBetween;
    });
  }

  [[nodiscard]] bool is_chosen(std::size_t room, RoomChoice choice) const {
    if (choice == RoomChoice::any) return true;
    const bool repeated = std::any_of(rooms_.begin(), rooms_.end(), [&](const BimRoom& other) {
      return &other != &rooms_[room] && alike(rooms_[room], other);
    });
    return repeated == (choice == RoomChoice::repeated);
  }

  [[nodiscard]] std::optional<BimStation> in_room(std::size_t index) {
    const BimRoom& room = rooms_[index];
    const Box2 box = box_of(room.outline);
    for (int attempt = 0; attempt < 400; ++attempt) {
      const Vector2d at = uniform_vector(box.low, box.high, random_);
      if (room_at({at.x(), at.y(), room.floor_m + 1.0}) != static_cast<int>(index)) continue;
      // From the middle of the height: the floor may lie a little above or below the named space's bottom.
      const auto place = on_floor({at.x(), at.y(), room.floor_m + 0.5 * std::min(room.height_m, 3.0)});
      if (place && clear(*place, kEnclosed)) return BimStation{*place, static_cast<int>(index)};
    }
    return std::nullopt;
  }

  /// A place in a model that names no rooms.
  [[nodiscard]] std::optional<BimStation> anywhere() {
    for (int attempt = 0; attempt < 20000; ++attempt) {
      Vector3d at;
      for (int axis = 0; axis < 3; ++axis) at[axis] = random_.uniform(low_[axis], high_[axis]);
      const auto place = on_floor(at);
      if (place && walls_near(*place) && clear(*place, kEnclosedUnnamed))
        return BimStation{*place, room_at(*place)};
    }
    return std::nullopt;
  }

  /// A random place along a random sight from a station.
  [[nodiscard]] std::optional<BimStation> in_sight_of(const BimStation& from) {
    const double azimuth = random_.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
    const RayHit hit = caster_.cast(from.position, direction);
    if (!hit.found() || hit.range_m < kBetween + kClearance) return std::nullopt;
    const double range = random_.uniform(kBetween, hit.range_m - kClearance);
    const auto place = on_floor(from.position + range * direction);
    // Stairs up or down are another storey: still in sight, but not for this purpose.
    if (!place || std::abs(place->z() - from.position.z()) > 0.45) return std::nullopt;
    const int room = room_at(*place);
    if (!rooms_.empty() && room < 0) return std::nullopt;
    if (!clear(*place, rooms_.empty() ? kEnclosedUnnamed : kEnclosed)) return std::nullopt;
    return BimStation{*place, room};
  }

  /// A tripod's height above the floor below `at`.
  [[nodiscard]] std::optional<Vector3d> on_floor(const Vector3d& at) {
    const RayHit down = caster_.cast(at, -Vector3d::UnitZ());
    if (!down.found() || down.inside || down.cosine < 0.98 || down.range_m > 4.0) return std::nullopt;
    const double height = random_.uniform(1.4, 1.8);
    const Vector3d foot = at - down.range_m * Vector3d::UnitZ();
    const RayHit up = caster_.cast(foot, Vector3d::UnitZ(), 1e-3);
    if (!up.found() || up.inside || up.range_m < std::max(kLeastHeight, height + 0.2)) return std::nullopt;
    if (up.range_m > kHighestCeiling) return std::nullopt;
    return foot + height * Vector3d::UnitZ();
  }

  [[nodiscard]] int room_at(const Vector3d& x) const {
    const Vector2d at = x.head<2>();
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      const BimRoom& room = rooms_[i];
      if (x.z() < room.floor_m - 0.1 || x.z() > room.floor_m + room.height_m) continue;
      const auto inside = [&](const Polygon& part) { return contains(part, at); };
      if (std::any_of(room.outline.begin(), room.outline.end(), inside)) return static_cast<int>(i);
    }
    return -1;
  }

  /// Walls on nearly all sides, and enough floor between them.
  [[nodiscard]] bool walls_near(const Vector3d& p) const {
    constexpr int kFan = 48;
    Ring seen;
    for (int i = 0; i < kFan; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / kFan;
      const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
      const RayHit hit = caster_.cast(p, direction);
      if (hit.found() && !hit.inside && hit.range_m < kFarthestWall)
        seen.emplace_back(hit.range_m * direction.x(), hit.range_m * direction.y());
    }
    return seen.size() >= kFan - 4 && signed_area(seen) >= kLeastArea;
  }

  /// Nothing within reach of the tripod, surfaces around, and never inside a solid.
  [[nodiscard]] bool clear(const Vector3d& p, double enclosed, double clearance = kClearance) const {
    for (const double tilt : {-0.7, -0.3, 0.0, 0.3}) {
      for (int i = 0; i < 24; ++i) {
        const double azimuth = 2.0 * std::numbers::pi * i / 24;
        const Vector3d direction(std::cos(tilt) * std::cos(azimuth), std::cos(tilt) * std::sin(azimuth),
                                 std::sin(tilt));
        const RayHit hit = caster_.cast(p, direction);
        if (hit.found() && (hit.inside || hit.range_m * std::cos(tilt) < clearance)) return false;
      }
    }
    int ended = 0;
    for (const Vector3d& direction : directions_) {
      const RayHit hit = caster_.cast(p, direction);
      if (hit.inside) return false;
      ended += hit.found() ? 1 : 0;
    }
    return ended >= enclosed * kRays;
  }

  const std::vector<BimRoom>& rooms_;
  const RayCaster& caster_;
  RandomStream& random_;
  std::vector<Vector3d> directions_;
  Vector3d low_ = Vector3d::Constant(1e300);
  Vector3d high_ = Vector3d::Constant(-1e300);
};

}  // namespace

std::vector<Vector3d> spread_directions(int count) {
  std::vector<Vector3d> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count;
    const double radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(golden * i), radius * std::sin(golden * i), z);
  }
  return directions;
}

std::vector<BimStation> place_bim_stations(const BimModel& model, const std::vector<BimRoom>& rooms,
                                           const RayCaster& caster, std::size_t count, RoomChoice choice,
                                           RandomStream& random) {
  BimSurveyor surveyor(rooms, caster, random);
  std::vector<BimStation> stations;
  if (choice == RoomChoice::doorways) stations = surveyor.in_doorways(model.openings, count);
  if (choice == RoomChoice::each || choice == RoomChoice::doorways) {
    stations = surveyor.through_all(std::move(stations), count);
    if (stations.size() < count)
      throw Error(fmt::format("the model's rooms have space for {} scanners", stations.size()),
                  "limen simulate", "ask for no more --stations");
  }
  while (stations.size() < count) {
    const auto station = stations.empty() ? surveyor.first(choice) : surveyor.next(stations);
    if (!station) {
      throw Error(stations.empty() ? "no room of the model has space for a scanner of this kind"
                                   : "the rooms have no space for so many scanners in sight of one another",
                  "limen simulate", "choose another --seed, --room or number of --stations");
    }
    stations.push_back(*station);
  }
  return stations;
}

}  // namespace limen
