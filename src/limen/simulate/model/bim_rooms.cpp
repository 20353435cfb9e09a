// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_rooms.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "limen/geometry/polygon_clip.h"

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

}  // namespace limen
