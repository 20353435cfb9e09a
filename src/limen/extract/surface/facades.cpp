// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/facades.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// Extent of the outer rings along a direction of space.
double extent_along(const PlanarPolygon& polygon, const Vector3d& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Polygon& part : polygon.parts) {
    for (const Vector2d& p : part.outer) {
      const double at = direction.dot(polygon.frame.to_space(p));
      low = std::min(low, at);
      high = std::max(high, at);
    }
  }
  return std::max(0.0, high - low);
}

constexpr double kMaxReliefAngle_rad = radians(5.0);

/// Parallel, seen from the same side, and within `max_relief_m` of the wall's plane.
bool in_relief(const PlanarPolygon& wall, const PlanarPolygon& other, double max_relief_m) {
  const double cosine = wall.plane.normal.dot(other.plane.normal);
  if (std::abs(cosine) < std::cos(kMaxReliefAngle_rad)) return false;
  if (wall.oriented && other.oriented && cosine < 0.0) return false;
  return std::abs(wall.plane.signed_distance(other.centroid)) <= max_relief_m;
}

}  // namespace

void FacadeCriteria::check() const {
  if (!(max_tilt_rad > 0.0 && max_tilt_rad < 0.25 * std::numbers::pi)) {
    throw_bad_option("max_tilt_rad", max_tilt_rad, "in (0, pi/4)");
  }
  if (!(min_area_m2 >= 0.0)) throw_bad_option("min_area_m2", min_area_m2, "at least 0");
  if (!(min_height_m >= 0.0)) throw_bad_option("min_height_m", min_height_m, "at least 0");
  if (!(min_width_m >= 0.0)) throw_bad_option("min_width_m", min_width_m, "at least 0");
}

std::vector<int> find_facades(const std::vector<PlanarPolygon>& polygons, const Vector3d& up,
                              const FacadeCriteria& options) {
  options.check();
  std::vector<std::pair<double, int>> found;  // area, index
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const PlanarPolygon& polygon = polygons[i];
    if (std::abs(polygon.plane.normal.dot(up)) > std::sin(options.max_tilt_rad)) continue;
    const Vector3d across = up.cross(polygon.plane.normal).normalized();
    if (extent_along(polygon, up) < options.min_height_m) continue;
    if (extent_along(polygon, across) < options.min_width_m) continue;
    const double area_m2 = area(filled(polygon.parts));
    if (area_m2 >= options.min_area_m2) found.emplace_back(area_m2, static_cast<int>(i));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<int> facades;
  for (const auto& [area_m2, index] : found) facades.push_back(index);
  return facades;
}

void WallOutlineOptions::check() const {
  if (!(close_gaps_m >= 0.0)) throw_bad_option("close_gaps_m", close_gaps_m, "at least 0");
  if (!(max_relief_m >= 0.0)) throw_bad_option("max_relief_m", max_relief_m, "at least 0");
}

std::vector<Polygon> wall_outline(const std::vector<PlanarPolygon>& polygons, int wall,
                                  const WallOutlineOptions& options) {
  options.check();
  const PlanarPolygon& base = polygons.at(static_cast<std::size_t>(wall));
  const std::vector<Polygon> own = filled(base.parts);
  std::vector<Polygon> pieces = own;
  for (const PlanarPolygon& other : polygons) {
    if (&other == &base || !in_relief(base, other, options.max_relief_m)) continue;
    const std::vector<Polygon> seen = projected(other.parts, other.frame, base.frame);
    pieces.insert(pieces.end(), seen.begin(), seen.end());
  }
  std::vector<Polygon> whole = filled(pieces);
  if (options.close_gaps_m > 0.0) {
    // Growing joins the banks of a gap; shrinking gives the outside back its place. What the wall had stays.
    const double half = 0.5 * options.close_gaps_m;
    whole = filled(merged(whole, grown(filled(grown(whole, half)), -half)));
  }
  // The house next door may stand on the same line.
  std::erase_if(whole, [&](const Polygon& part) { return intersection_area({part}, own) <= 0.0; });
  return whole;
}

}  // namespace limen
