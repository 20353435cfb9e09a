// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/built_planes.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

// What is the building's: its large planes, and what is near them.
constexpr double kBeforeWallM = 0.25;   // frames, sills, radiators, skirtings: built with the wall
constexpr double kBehindWallM = 0.6;    // reveals, frames, panes
constexpr double kBesideWallM = 0.3;    // beyond the outline that was seen of it
constexpr double kBelowCeilingM = 0.5;  // lintels, beams, what shows of a wall above furniture
constexpr double kSameWallM = 0.04;     // strips of a wall that furniture cuts in pieces lie in one plane ...
constexpr double kSameWallCosine = 0.9994;  // ... to 2 degrees
constexpr double kLevelCosine = 0.95;
constexpr double kAtStripM = 0.1;  // before and beside a strip

constexpr double kUprightCosine = 0.3;  // of a wall's normal to the vertical

}  // namespace

bool BuiltPlanes::Part::is_above(const Vector3d& x) const {
  if (plane.normal.z() > -kLevelCosine) return false;
  const double below = plane.signed_distance(x);
  if (below <= 0.0 || below > kBelowCeilingM) return false;
  const Vector2d margin = Vector2d::Constant(kBesideWallM);
  return Box2{box.low - margin, box.high + margin}.contains(frame.to_plane(x));
}

BuiltPlanes::BuiltPlanes(const ScanView& view) : built_(view.features->planes.size(), false) {
  const std::vector<PlanarPolygon>& planes = view.features->planes;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (of_building(planes[i])) add(i, planes[i], false);
  const std::vector<Part> large = parts_;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (!built_[i] && (reaches_ceiling(planes[i], large) || continues_wall(planes[i], large)))
      add(i, planes[i], true);
}

BuiltPlanes::Place BuiltPlanes::place(const Vector3d& x) const {
  Place found = Place::off;
  for (const Part& part : parts_) {
    if (part.is_above(x)) return Place::at_wall;
    const double distance = part.plane.signed_distance(x);
    if (distance > (part.strip ? kAtStripM : kBeforeWallM)) continue;
    if (part.strip && distance < -kBehindWallM) continue;
    const Vector2d at = part.frame.to_plane(x);
    const Vector2d margin = Vector2d::Constant(part.strip ? kAtStripM : kBesideWallM);
    if (!Box2{part.box.low - margin, part.box.high + margin}.contains(at)) continue;
    if (distance > -kBehindWallM) return Place::at_wall;
    found = Place::behind;
  }
  return found;
}

bool BuiltPlanes::between(const Vector3d& a, const Vector3d& b) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    const double from = part.plane.signed_distance(a);
    const double to = part.plane.signed_distance(b);
    if (from * to >= 0.0) return false;
    const Vector3d crossing = a + (b - a) * (from / (from - to));
    const Vector2d margin = Vector2d::Constant(kBesideWallM);
    return Box2{part.box.low - margin, part.box.high + margin}.contains(part.frame.to_plane(crossing));
  });
}

void BuiltPlanes::add(std::size_t i, const PlanarPolygon& plane, bool strip) {
  built_[i] = true;
  for (const Polygon& part : plane.parts) parts_.push_back({plane.plane, plane.frame, box_of({part}), strip});
}

bool BuiltPlanes::reaches_ceiling(const PlanarPolygon& plane, const std::vector<Part>& large) {
  if (std::abs(plane.plane.normal.z()) > kUprightCosine) return false;
  for (const Polygon& part : plane.parts) {
    for (const Vector2d& corner : part.outer) {
      const Vector3d x = plane.frame.to_space(corner);
      if (std::any_of(large.begin(), large.end(), [&](const Part& one) { return one.is_above(x); }))
        return true;
    }
  }
  return false;
}

bool BuiltPlanes::continues_wall(const PlanarPolygon& plane, const std::vector<Part>& large) {
  const Box2 box = box_of(plane.parts);
  if (box.empty()) return false;
  const Vector3d middle = plane.frame.to_space(0.5 * (box.low + box.high));
  return std::any_of(large.begin(), large.end(), [&](const Part& wall) {
    return std::abs(wall.plane.normal.z()) < kUprightCosine &&
           wall.plane.normal.dot(plane.plane.normal) > kSameWallCosine &&
           std::abs(wall.plane.signed_distance(middle)) < kSameWallM;
  });
}

}  // namespace limen
