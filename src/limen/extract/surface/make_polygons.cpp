// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/make_polygons.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/planes/join_pieces.h"
#include "limen/geometry/alpha_shape.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kPieceGapM = 0.4;  // pieces of a plane farther apart are planes of their own
constexpr std::size_t kFewestOfPiece = 25;

PlaneFit fit_of(const Scan& scan, const std::vector<std::uint32_t>& points) {
  const Vector3d anchor = scan.points[points.front()];
  PointMoments moments;
  for (const std::uint32_t i : points) moments.add(scan.points[i] - anchor);
  PlaneFit fit = fit_plane(moments);
  fit.plane = shifted(fit.plane, -anchor);
  fit.centroid += anchor;
  return fit;
}

}  // namespace

PlaneLabels split_planes(const Scan& scan, const PlaneLabels& planes) {
  PlaneLabels split;
  split.inlier_threshold_m = planes.inlier_threshold_m;
  split.labels.assign(planes.labels.size(), -1);
  const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const std::vector<std::uint32_t>& piece :
         touching_parts(scan, planes.fits[k], points[k], kPieceGapM)) {
      if (piece.size() < kFewestOfPiece) break;
      for (const std::uint32_t i : piece) split.labels[i] = static_cast<std::int32_t>(split.fits.size());
      split.fits.push_back(fit_of(scan, piece));
    }
  }
  return split;
}

namespace {

constexpr double kOrientedShare = 0.9;  // of the rays that must come from one side

/// Share of (at most 512) inliers whose scanner is on the side of the normal.
double share_in_front(const Scan& scan, const std::vector<std::uint32_t>& points, const Plane& plane) {
  const std::size_t step = 1 + points.size() / 512;
  double front = 0;
  double tested = 0;
  for (std::size_t k = 0; k < points.size(); k += step, ++tested) {
    if (plane.signed_distance(scan.centre(points[k])) > 0) ++front;
  }
  return front / tested;
}

double alpha_for(const PlaneFit& fit, std::size_t count) {
  const double extent_m2 = 12.0 * std::sqrt(fit.variances[1] * fit.variances[2]);
  return std::clamp(6.0 * std::sqrt(extent_m2 / static_cast<double>(count)), 0.16, 0.8);
}

PlanarPolygon make_polygon(const Scan& scan, const PlaneFit& fit, const std::vector<std::uint32_t>& points,
                           const PolygonOptions& options) {
  PlanarPolygon polygon;
  polygon.plane = fit.plane;
  polygon.inliers = points.size();
  polygon.rms_m = fit.rms_m;
  polygon.centroid = fit.centroid;
  if (scan.centre_known()) {
    const double front = share_in_front(scan, points, fit.plane);
    if (front < 0.5) polygon.plane = fit.plane.flipped();
    polygon.oriented = std::max(front, 1.0 - front) >= kOrientedShare;
  }
  polygon.frame = make_frame(polygon.plane, fit.centroid);
  std::vector<Vector2d> flat;
  flat.reserve(points.size());
  for (const std::uint32_t i : points) flat.push_back(polygon.frame.to_plane(scan.points[i]));
  AlphaShapeOptions shape;
  shape.alpha_m = options.alpha_m > 0 ? options.alpha_m : alpha_for(fit, points.size());
  shape.min_part_m2 = options.min_part_m2;
  shape.min_hole_m2 = options.min_hole_m2;
  polygon.parts = simplified(alpha_shape(flat, shape), options.simplify_m);
  polygon.area_m2 = area(polygon.parts);
  return polygon;
}

}  // namespace

void PolygonOptions::check() const {
  constexpr double kFinestM = 0.001;  // no scan of a building has denser points
  if (alpha_m != 0.0 && !(alpha_m >= kFinestM)) throw_bad_option("alpha_m", alpha_m, "0, or 0.001 or more");
  if (min_part_m2 < 0) throw_bad_option("min_part_m2", min_part_m2, "0 or more");
  if (min_hole_m2 < 0) throw_bad_option("min_hole_m2", min_hole_m2, "0 or more");
  if (simplify_m < 0) throw_bad_option("simplify_m", simplify_m, "0 or more");
}

std::vector<PlanarPolygon> make_polygons(const Scan& scan, const PlaneLabels& labels,
                                         const PolygonOptions& options, Monitor& monitor) {
  options.check();
  const std::vector<std::vector<std::uint32_t>> points = points_of(labels.labels, labels.fits.size());
  std::vector<PlanarPolygon> polygons(points.size());
  parallel_for(points.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      monitor.throw_if_cancelled();
      polygons[k] = make_polygon(scan, labels.fits[k], points[k], options);
    }
  });
  return polygons;
}

}  // namespace limen
