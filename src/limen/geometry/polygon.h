// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/plane.h"

namespace limen {

/// A closed ring of plane coordinates, metres; the last point is not repeated.
using Ring = std::vector<Vector2d>;

/// A simple polygon with holes: `outer` counter-clockwise, holes clockwise.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// Signed area of a ring, m^2: positive when counter-clockwise.
double signed_area(const Ring& ring);
/// Area of the polygon less its holes, m^2.
double area(const Polygon& polygon);
double area(const std::vector<Polygon>& polygons);
/// Length of all rings, m.
double outline_length(const Polygon& polygon);
/// Even-odd test against one ring.
bool contains(const Ring& ring, const Vector2d& p);
/// Inside the outer ring and in no hole.
bool contains(const Polygon& polygon, const Vector2d& p);

/// Where the line y crosses the polygon's rings, ascending: (x, y) lies in the polygon, as `contains` has it,
/// where the number of crossings beyond x is odd. Holes must lie in the outer ring and apart.
std::vector<double> crossings(const Polygon& polygon, double y);

/// A bounded piece of a plane as a scan saw it: one plane, one or more polygons with holes (a wall behind a
/// column has two parts), and the points that support it.
struct PlanarPolygon {
  Plane plane;
  PlaneFrame frame;                      ///< 2-D coordinates of `parts`
  std::vector<Polygon> parts;            ///< largest first
  std::size_t inliers = 0;               ///< points within the inlier threshold
  double rms_m = 0.0;                    ///< root mean square distance of the inliers
  double area_m2 = 0.0;                  ///< of all parts, holes taken out
  Vector3d centroid = Vector3d::Zero();  ///< mean of the inliers
  bool oriented = false;                 ///< the normal points to the side the scanner saw
  bool interior = false;  ///< seen through the openings of a wall: inside from a street, outside from a room
};

}  // namespace limen
