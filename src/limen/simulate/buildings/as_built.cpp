// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// The sizes follow DIN 18202 (16 mm on 3-6 m in plan, 12 mm on openings, 8 mm on 1-3 m of angle) and what is
// measured in old houses: walls lean by 0.1 to 0.5 degrees.
#include "limen/simulate/buildings/as_built.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

// Standard deviations of the worst building; a good one has half of them.
constexpr double kWallOffset = 0.0055;  ///< both faces of a wall together
constexpr double kFaceOffset = 0.003;   ///< one face against the other
const double kWallLean = radians(0.32);
const double kFaceLean = radians(0.14);
constexpr double kBulge = 0.002;
constexpr double kLevelOffset = 0.005;
const double kSlope = radians(0.12);
constexpr double kOpeningOffset = 0.004;
const double kOpeningTurn = radians(0.2);

/// Beyond this length or height a wall is held by its ends: it leans less.
constexpr double kHeldFrom = 3.0;

/// Nothing is farther off than two standard deviations and a half: what is, is torn down.
double off(double sigma, RandomStream& random) {
  return sigma * std::clamp(random.normal(), -2.5, 2.5);
}

Plane drawn_plane(const WallFace& face) {
  const Vector2d normal = face.normal();
  return {{normal.x(), normal.y(), 0.0}, normal.dot(face.a)};
}

/// `drawn` moved along its normal, which is turned about `pivot`.
Plane deviated(const Plane& drawn, const Vector3d& pivot, const Vector3d& along, const Vector3d& up,
               const PlaneDeviation& by) {
  const Vector3d normal = (drawn.normal + by.lean_rad * up + by.turn_rad * along).normalized();
  return {normal, normal.dot(pivot + by.offset_m * drawn.normal)};
}

/// The point of three planes that is meant by `drawn`. Nothing: they nearly meet in a line.
std::optional<Vector3d> meeting_point(const Plane& a, const Plane& b, const Plane& c, const Vector3d& drawn) {
  const Vector3d bc = b.normal.cross(c.normal);
  const double det = a.normal.dot(bc);
  if (std::abs(det) < 0.05) return std::nullopt;
  const Vector3d shift =
      (-a.signed_distance(drawn) * bc - b.signed_distance(drawn) * c.normal.cross(a.normal) -
       c.signed_distance(drawn) * a.normal.cross(b.normal)) /
      det;
  return drawn + shift;
}

Ring ring_of(const FloorPlan& plan, std::size_t space) {
  return space < plan.rooms.size() ? plan.rooms[space].outline : plan.envelope;
}

std::array<double, 2> levels_of(const FloorPlan& plan, std::size_t space) {
  if (space < plan.rooms.size()) return {plan.rooms[space].floor_m, plan.rooms[space].ceiling_m};
  return {plan.base_m, plan.roof_m};
}

/// Faces that belong to one wall get one number.
std::vector<std::size_t> walls_of(std::size_t faces,
                                  const std::vector<std::array<std::size_t, 2>>& back_to_back) {
  std::vector<std::size_t> wall(faces);
  std::iota(wall.begin(), wall.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (wall[i] != i) i = wall[i];
    return i;
  };
  for (const auto& [a, b] : back_to_back) {
    const std::size_t one = root(a);
    const std::size_t other = root(b);
    wall[std::max(one, other)] = std::min(one, other);
  }
  for (std::size_t i = 0; i < faces; ++i) wall[i] = root(i);
  return wall;
}

}  // namespace

AsBuilt::AsBuilt(const FloorPlan& plan, const std::vector<WallFace>& faces,
                 const std::vector<std::array<std::size_t, 2>>& back_to_back, std::uint64_t seed)
    : plan_(plan), faces_(faces), seed_(seed), walls_(faces.size()), spaces_(plan.rooms.size() + 1) {
  quality_ = RandomStream(seed, 1).uniform(0.5, 1.0);
  draw_walls(back_to_back);
  gather_spaces();
  for (std::size_t space = 0; space < spaces_.size(); ++space) build(space);
}

void AsBuilt::draw_walls(const std::vector<std::array<std::size_t, 2>>& back_to_back) {
  const std::vector<std::size_t> wall = walls_of(faces_.size(), back_to_back);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const WallFace& face = faces_[i];
    RandomStream common(seed_, 1000 + wall[i]);
    RandomStream own(seed_, 1000000 + i);
    // Both faces of a wall go the same way: against the normal of the one, along that of the other.
    const double side = face.normal().dot(faces_[wall[i]].normal()) > 0.0 ? 1.0 : -1.0;
    const double held = std::min(1.0, kHeldFrom / (face.high_m - face.low_m));
    PlaneDeviation by;
    by.offset_m = quality_ * (side * off(kWallOffset, common) + off(kFaceOffset, own));
    by.lean_rad = quality_ * held * (side * off(kWallLean, common) + off(kFaceLean, own));
    by.turn_rad = quality_ * std::min(1.0, kHeldFrom / face.length()) * off(kFaceLean, own);
    wall_deviations_.push_back(by);
  }
}

void AsBuilt::gather_spaces() {
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const int room = faces_[i].room;
    (room < 0 ? spaces_.back() : spaces_[static_cast<std::size_t>(room)]).faces.push_back(i);
  }
}

void AsBuilt::build(std::size_t index) {
  BuiltSpace& space = spaces_[index];
  const bool outside = index == plan_.rooms.size();
  Ring ring;
  for (const std::size_t face : space.faces) ring.push_back(outside ? faces_[face].b : faces_[face].a);
  // Where a narrow piece of wall would vanish between its neighbours, they were built with more care.
  for (const double share : {1.0, 0.5, 0.25, 0.0}) {
    set_planes(index, share);
    if (place_corners(index, ring)) return;
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    space.low_corners[i] = {ring[i].x(), ring[i].y(), levels_of(plan_, index)[0]};
    space.high_corners[i] = {ring[i].x(), ring[i].y(), levels_of(plan_, index)[1]};
  }
}

void AsBuilt::set_planes(std::size_t index, double share) {
  BuiltSpace& space = spaces_[index];
  for (const std::size_t i : space.faces) {
    const WallFace& face = faces_[i];
    const Vector2d middle = 0.5 * (face.a + face.b);
    const PlaneDeviation& by = wall_deviations_[i];
    walls_[i] = deviated(drawn_plane(face), {middle.x(), middle.y(), 0.5 * (face.low_m + face.high_m)},
                         face.frame().u, Vector3d::UnitZ(),
                         {share * by.offset_m, share * by.lean_rad, share * by.turn_rad});
  }
  space.low = level_plane(index, false, share);
  space.high = level_plane(index, true, share);
}

Plane AsBuilt::level_plane(std::size_t index, bool high, double share) const {
  const bool outside = index == plan_.rooms.size();
  const Ring ring = ring_of(plan_, index);
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : ring) middle += p / static_cast<double>(ring.size());
  const Box2 box = box_of(ring);
  const double z = levels_of(plan_, index)[high ? 1 : 0];
  const Vector3d up = high && !outside ? Vector3d(-Vector3d::UnitZ()) : Vector3d(Vector3d::UnitZ());
  const Plane drawn{up, up.z() * z};
  // A building is in the ground: no gap is below its walls.
  if (outside && !high) return drawn;
  RandomStream random(seed_, 2000000 + 2 * index + (high ? 1U : 0U));
  const double held = quality_ * share * std::min(1.0, kHeldFrom / (box.high - box.low).maxCoeff());
  PlaneDeviation by;
  by.offset_m = quality_ * share * off(kLevelOffset, random);
  by.lean_rad = held * off(kSlope, random);
  by.turn_rad = held * off(kSlope, random);
  return deviated(drawn, {middle.x(), middle.y(), z}, Vector3d::UnitX(), Vector3d::UnitY(), by);
}

bool AsBuilt::place_corners(std::size_t index, const Ring& ring) {
  BuiltSpace& space = spaces_[index];
  const auto [low, high] = levels_of(plan_, index);
  const std::size_t n = ring.size();
  space.low_corners.assign(n, Vector3d::Zero());
  space.high_corners.assign(n, Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    const Plane& before = walls_[space.faces[(i + n - 1) % n]];
    const Plane& after = walls_[space.faces[i]];
    const auto below = meeting_point(space.low, before, after, {ring[i].x(), ring[i].y(), low});
    const auto above = meeting_point(space.high, before, after, {ring[i].x(), ring[i].y(), high});
    if (!below || !above) return false;
    space.low_corners[i] = *below;
    space.high_corners[i] = *above;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const Vector2d side = ring[next] - ring[i];
    for (const auto& corners : {space.low_corners, space.high_corners})
      if (side.dot((corners[next] - corners[i]).head<2>()) < 0.4 * side.squaredNorm()) return false;
  }
  return true;
}

std::array<Vector3d, 4> AsBuilt::corners(std::size_t face) const {
  const bool outside = faces_[face].room < 0;
  const BuiltSpace& space = outside ? spaces_.back() : spaces_[static_cast<std::size_t>(faces_[face].room)];
  const auto found = std::find(space.faces.begin(), space.faces.end(), face);
  std::size_t left = static_cast<std::size_t>(found - space.faces.begin());
  std::size_t right = (left + 1) % space.faces.size();
  // Seen from outside a ring runs to the right, seen from inside to the left.
  if (!outside) std::swap(left, right);
  return {space.low_corners[left], space.low_corners[right], space.high_corners[right],
          space.high_corners[left]};
}

Bulge AsBuilt::bulge(std::size_t face) const {
  const std::array<Vector3d, 4> corner = corners(face);
  const Vector3d u = corner[1] - corner[0];
  const Vector3d v = corner[3] - corner[0];
  // Short walls are straight.
  const double share = std::min(1.0, u.norm() / kHeldFrom);
  RandomStream random(seed_, 4000000 + face);
  return {quality_ * share * off(kBulge, random), corner[0], u / u.squaredNorm(), v / v.squaredNorm()};
}

AffineMap AsBuilt::in_room(std::size_t index) const {
  const BuiltSpace& space = spaces_[index];
  const Room& room = plan_.rooms[index];
  // In plan: the least squares fit to how the corners moved, about the middle of the room.
  Vector3d middle = Vector3d::Zero();
  std::vector<std::array<Vector3d, 2>> moves;
  for (std::size_t i = 0; i < space.faces.size(); ++i) {
    const Vector2d& p = faces_[space.faces[i]].a;
    moves.push_back({Vector3d(p.x(), p.y(), room.floor_m), space.low_corners[i]});
    moves.push_back({Vector3d(p.x(), p.y(), room.ceiling_m), space.high_corners[i]});
  }
  for (const auto& move : moves) middle += move[0] / static_cast<double>(moves.size());
  Matrix4d normal = Matrix4d::Zero();
  Eigen::Vector4d right_x = Eigen::Vector4d::Zero();
  Eigen::Vector4d right_y = Eigen::Vector4d::Zero();
  for (const auto& [drawn, built] : moves) {
    const Vector3d at = drawn - middle;
    const Eigen::Vector4d row(at.x(), at.y(), at.z(), 1.0);
    normal += row * row.transpose();
    right_x += (built.x() - drawn.x()) * row;
    right_y += (built.y() - drawn.y()) * row;
  }
  AffineMap map;
  const Eigen::Vector4d x = solve_symmetric(normal, right_x);
  const Eigen::Vector4d y = solve_symmetric(normal, right_y);
  map.linear.row(0) += x.head<3>().transpose();
  map.linear.row(1) += y.head<3>().transpose();
  map.shift = {x[3] - x.head<3>().dot(middle), y[3] - y.head<3>().dot(middle), 0.0};
  // Upright: the floor goes to the floor, the ceiling above the room's middle to the ceiling.
  const auto height = [](const Plane& plane, const Vector3d& at) {
    return (plane.offset - plane.normal.head<2>().dot(at.head<2>())) / plane.normal.z();
  };
  const Vector3d moved = map(middle);
  const double stretch =
      (height(space.high, moved) - height(space.low, moved)) / (room.ceiling_m - room.floor_m);
  const Vector2d slope = -space.low.normal.head<2>() / space.low.normal.z();
  map.linear.row(2) = slope.x() * map.linear.row(0) + slope.y() * map.linear.row(1);
  map.linear(2, 2) += stretch;
  map.shift.z() =
      space.low.offset / space.low.normal.z() + slope.dot(map.shift.head<2>()) - stretch * room.floor_m;
  return map;
}

AffineMap AsBuilt::at_face(std::size_t face) const {
  const Plane drawn = drawn_plane(faces_[face]);
  const Plane& built = walls_[face];
  const double slope = built.normal.dot(drawn.normal);
  const Vector3d across = built.normal - slope * drawn.normal;
  AffineMap map;
  map.linear -= drawn.normal * across.transpose() / slope;
  map.shift = (built.offset - slope * drawn.offset) / slope * drawn.normal;
  return map;
}

double AsBuilt::least_sill_clearance(const BuiltOpening& built, const OpeningShape& shape, std::size_t inner,
                                     std::size_t outer) const {
  const std::array<Vector3d, 4> inside = built.inner_corners(shape);
  const std::array<Vector3d, 4> outside = built.outer_corners(shape);
  double least = 1.0;
  const auto see = [&](int room, const std::array<Vector3d, 4>& corners) {
    if (room < 0) return;
    const Plane& floor = spaces_[static_cast<std::size_t>(room)].low;
    least = std::min({least, floor.signed_distance(corners[0]), floor.signed_distance(corners[1])});
  };
  see(faces_[inner].room, inside);
  see(faces_[outer].room, outside);
  return least;
}

BuiltOpening AsBuilt::opening(const OpeningShape& shape, std::size_t inner, std::size_t outer) const {
  RandomStream random(seed_, 3000000 + static_cast<std::uint64_t>(shape.id));
  const double w = shape.width_m;
  const double h = shape.height_m;
  const Vector3d middle = shape.at(0.5 * w, 0.5 * h, 0.5 * shape.thickness_m);
  const Vector3d u = shape.outer.u;
  const Vector3d v = shape.outer.v;
  const Vector3d in = -u.cross(v);
  // What both faces of the wall did there, on average, inwards.
  const auto with_wall = [&](double at_u, double at_v) {
    const auto inwards = [&](const Plane& plane, double depth) {
      return -plane.signed_distance(shape.at(at_u, at_v, depth)) / plane.normal.dot(in);
    };
    return 0.5 * (inwards(walls_[outer], 0.0) + inwards(walls_[inner], shape.thickness_m));
  };
  const double sigma = quality_ * kOpeningOffset;
  const double turn = quality_ * kOpeningTurn;
  const double base = with_wall(0.5 * w, 0.5 * h);
  const Vector3d shift =
      off(sigma, random) * u + off(sigma, random) * v + (base + off(0.5 * sigma, random)) * in;
  // Linear map from the place in the opening (along u, v, inwards) to the displacement along the same axes.
  Matrix3d slope = Matrix3d::Zero();
  slope(0, 0) = off(sigma, random) / w;
  slope(1, 1) = off(sigma, random) / h;
  slope(0, 1) = off(turn, random);
  slope(1, 0) = off(0.5 * turn, random);
  slope(0, 2) = off(turn, random);
  slope(1, 2) = off(turn, random);
  slope(2, 0) = (with_wall(w, 0.5 * h) - with_wall(0.0, 0.5 * h)) / w + off(0.5 * turn, random);
  slope(2, 1) = (with_wall(0.5 * w, h) - with_wall(0.5 * w, 0.0)) / h + off(0.5 * turn, random);
  Matrix3d axes;
  axes << u, v, in;
  BuiltOpening built{.map = {}, .outer = walls_[outer], .inner = walls_[inner]};
  built.map.linear = Matrix3d::Identity() + axes * slope * axes.transpose();
  built.map.shift = shift + middle - built.map.linear * middle;
  if (shape.kind == OpeningKind::window) return built;
  // A door has a threshold of some millimetres above the higher floor.
  built.map.shift += (random.uniform(0.002, 0.008) - least_sill_clearance(built, shape, inner, outer)) * v;
  return built;
}

}  // namespace limen
