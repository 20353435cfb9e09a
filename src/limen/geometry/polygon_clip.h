// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"

namespace limen {

/// Set operations on areas of one plane. Each argument is the union of its polygons: they may overlap or
/// touch, and their rings may run either way (outer rings count as filled, holes as empty).
/// Coordinates are rounded to a grid of 10 um. Results: disjoint polygons, outer rings counter-clockwise,
/// holes clockwise, largest first. Throw Error where a coordinate is not finite or beyond 1e9 m.
std::vector<Polygon> intersection(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
std::vector<Polygon> difference(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
std::vector<Polygon> merged(const std::vector<Polygon>& a, const std::vector<Polygon>& b = {});

/// Area of the intersection, m^2, without building it; areas whose boxes are apart cost next to nothing.
double intersection_area(const std::vector<Polygon>& a, const std::vector<Polygon>& b);
/// Area of the union of `polygons`, m^2: overlaps count once.
double union_area(const std::vector<Polygon>& polygons);

/// The polygons without their holes; parts that lay inside a hole of another are swallowed.
std::vector<Polygon> filled(const std::vector<Polygon>& polygons);
/// The polygons grown by `distance_m` (mitred corners), or shrunk where it is negative.
std::vector<Polygon> grown(const std::vector<Polygon>& polygons, double distance_m);

/// The ring with fewer points, none of the old ones further than `tolerance_m` from the new outline
/// (Douglas-Peucker on the closed ring). Fewer than three points left: an empty ring. The result may touch
/// itself where the ring has necks narrower than the tolerance; the operations above accept that.
Ring simplify_ring(const Ring& ring, double tolerance_m);
/// simplify_ring on every ring; rings that vanish are left out.
std::vector<Polygon> simplified(const std::vector<Polygon>& polygons, double tolerance_m);

/// The polygons, given in the plane coordinates of `from`, moved by `b_from_a` and projected along the
/// normal of `to` (frame in b) into its plane coordinates. Rings turn round when seen from behind.
std::vector<Polygon> projected(const std::vector<Polygon>& polygons, const PlaneFrame& from,
                               const PlaneFrame& to, const Rigid3& b_from_a = {});

/// Axis-aligned box of plane coordinates; empty: low > high.
struct Box2 {
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = Vector2d::Constant(-1e300);

  void add(const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] bool empty() const { return low.x() > high.x() || low.y() > high.y(); }
  [[nodiscard]] bool contains(const Vector2d& p) const {
    return p.x() >= low.x() && p.y() >= low.y() && p.x() <= high.x() && p.y() <= high.y();
  }
  /// Whether the boxes have no area in common; an empty one has none with any.
  [[nodiscard]] bool apart(const Box2& other) const {
    return empty() || other.empty() || low.x() >= other.high.x() || other.low.x() >= high.x() ||
           low.y() >= other.high.y() || other.low.y() >= high.y();
  }
};
Box2 box_of(const Ring& ring);
Box2 box_of(const std::vector<Polygon>& polygons);

}  // namespace limen
