// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/polygon_distance.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kAgreeingPlanesRad = radians(10.0);  // planes that differ by more do not agree at all

/// A polygon of the other scan that may meet the one in question, and the weight of equation 10.
struct NearPolygon {
  std::size_t index = 0;
  double weight = 0.0;
};

std::vector<NearPolygon> candidates(const PlanarPolygon& a, const std::vector<PlanarPolygon>& scan,
                                    double max_distance_m) {
  std::vector<NearPolygon> found;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (angle_between(a.plane, scan[i].plane) > kAgreeingPlanesRad) continue;
    const double ratio = bisector_distance(a, scan[i]) / max_distance_m;
    if (ratio < 1.0) found.push_back({i, 1.0 - ratio * ratio});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const NearPolygon& p, const NearPolygon& q) { return p.weight > q.weight; });
  return found;
}

}  // namespace

PlanarPolygon transformed(const Rigid3& b_from_a, const PlanarPolygon& polygon_in_a) {
  PlanarPolygon moved = polygon_in_a;
  moved.plane = transformed(b_from_a, polygon_in_a.plane);
  moved.frame.origin = b_from_a * polygon_in_a.frame.origin;
  moved.frame.u = b_from_a.rotation * polygon_in_a.frame.u;
  moved.frame.v = b_from_a.rotation * polygon_in_a.frame.v;
  moved.centroid = b_from_a * polygon_in_a.centroid;
  return moved;
}

double angle_between(const Plane& a, const Plane& b) {
  // acos |n1 . n2|, written so that small angles keep their digits.
  return std::atan2(a.normal.cross(b.normal).norm(), std::abs(a.normal.dot(b.normal)));
}

Plane bisector(const Plane& a, const Plane& b) {
  const Plane aligned = a.normal.dot(b.normal) < 0.0 ? b.flipped() : b;
  const Vector3d sum = a.normal + aligned.normal;  // at least sqrt(2) long
  return {sum.normalized(), (a.offset + aligned.offset) / sum.norm()};
}

double bisector_distance(const PlanarPolygon& a, const PlanarPolygon& b) {
  const Plane middle = bisector(a.plane, b.plane);
  return std::abs(middle.signed_distance(a.centroid)) + std::abs(middle.signed_distance(b.centroid));  // (7)
}

ProjectedPair project_to_bisector(const PlanarPolygon& a, const PlanarPolygon& b) {
  ProjectedPair pair;
  pair.frame = make_frame(bisector(a.plane, b.plane), a.frame.origin);
  pair.a = projected(a.parts, a.frame, pair.frame);
  pair.b = projected(b.parts, b.frame, pair.frame);
  return pair;
}

double overlap_area(const PlanarPolygon& a, const PlanarPolygon& b) {
  const ProjectedPair pair = project_to_bisector(a, b);
  return intersection_area(pair.a, pair.b);
}

double overlap_ratio(const PlanarPolygon& a, const PlanarPolygon& b) {
  const ProjectedPair pair = project_to_bisector(a, b);
  const double common = intersection_area(pair.a, pair.b);
  if (common <= 0.0) return 0.0;
  const double smaller = std::min(union_area(pair.a), union_area(pair.b));
  return smaller > 0.0 ? std::min(1.0, common / smaller) : 0.0;  // (8)
}

double agreement(const PlanarPolygon& a, const std::vector<PlanarPolygon>& scan, double max_distance_m) {
  const std::vector<NearPolygon> found = candidates(a, scan, max_distance_m);
  if (found.size() == 1) return found[0].weight * overlap_area(a, scan[found[0].index]);
  // Heaviest first: each adds only what the ones before it left open.
  std::vector<Polygon> covered;
  double covered_m2 = 0.0;
  double total = 0.0;
  for (const NearPolygon& candidate : found) {
    const ProjectedPair pair = project_to_bisector(a, scan[candidate.index]);
    const std::vector<Polygon> common = intersection(pair.a, pair.b);
    if (common.empty()) continue;
    covered = merged(covered, projected(common, pair.frame, a.frame));
    const double now_m2 = area(covered);
    total += candidate.weight * std::max(0.0, now_m2 - covered_m2);  // (10)
    covered_m2 = now_m2;
  }
  return total;
}

double scan_agreement(const std::vector<PlanarPolygon>& a, const std::vector<PlanarPolygon>& b,
                      double max_distance_m) {
  double total = 0.0;
  for (const PlanarPolygon& polygon : a) total += agreement(polygon, b, max_distance_m);
  for (const PlanarPolygon& polygon : b) total += agreement(polygon, a, max_distance_m);
  return 0.5 * total;
}

}  // namespace limen
