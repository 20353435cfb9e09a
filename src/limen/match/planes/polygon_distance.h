// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/polygon.h"

// Djahel, Monasse, Vallet, "Towards efficient indoor/outdoor registration using planar polygons", 2021,
// sections 3.2.1 and 3.2.2, equations 7 to 10.
//
// Departures from the printed text:
// - the angle between planes is that of undirected normals, and normals are aligned in sign before the
//   bisector plane is formed: as printed, opposed normals would give the other bisector;
// - the overlap (8) is 0 where a polygon has no area;
// - equation 9 is a cost and 10 a score, although both carry one name; `agreement` is the score (10), and the
//   cost (9) is |P1| - (10);
// - where several polygons of the other scan cover one place, the place counts once, for the nearest of them:
//   the printed sum can exceed |P1|;
// - rdist is symmetrised, so that it does not matter which scan comes first.
//
// All polygons of one call are in one frame. Areas in m^2, angles in radians.

namespace limen {

/// The polygon in another frame; 2-D coordinates stay the same.
PlanarPolygon transformed(const Rigid3& b_from_a, const PlanarPolygon& polygon_in_a);

/// Angle between two planes, in [0, pi/2].
double angle_between(const Plane& a, const Plane& b);
/// The plane halfway between two planes, its normal on the side of a's; for parallel planes the middle one.
Plane bisector(const Plane& a, const Plane& b);
/// Equation 7: the distances of both centroids to the bisector plane, added. A cost in metres.
double bisector_distance(const PlanarPolygon& a, const PlanarPolygon& b);

/// Projections of two polygons onto their bisector plane.
struct ProjectedPair {
  PlaneFrame frame;        ///< on the bisector plane
  std::vector<Polygon> a;  ///< in that frame
  std::vector<Polygon> b;
};
ProjectedPair project_to_bisector(const PlanarPolygon& a, const PlanarPolygon& b);

/// |a' n b'| on the bisector plane, m^2.
double overlap_area(const PlanarPolygon& a, const PlanarPolygon& b);
/// Equation 8: |a' n b'| / min(|a'|, |b'|), in [0, 1]; 0 where one has no area.
double overlap_ratio(const PlanarPolygon& a, const PlanarPolygon& b);

inline constexpr double kAgreeingPlanesM = 0.1;  ///< d_thr of equations 9 and 10

/// Equation 10: how much of `a` is met by the polygons of `scan`, weighted by 1 - distance^2 / d_thr^2.
/// A score in m^2, between 0 and the area of `a`.
double agreement(const PlanarPolygon& a, const std::vector<PlanarPolygon>& scan,
                 double max_distance_m = kAgreeingPlanesM);
/// Mean over both directions of the summed agreement: the criterion that the best pose maximises, m^2.
double scan_agreement(const std::vector<PlanarPolygon>& a, const std::vector<PlanarPolygon>& b,
                      double max_distance_m = kAgreeingPlanesM);

}  // namespace limen
