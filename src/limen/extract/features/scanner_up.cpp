// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/features/scanner_up.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "limen/base/angles.h"
#include "limen/extract/features/extract_features.h"

namespace limen {
namespace {

constexpr std::size_t kLooked = 120000;  // points looked at
constexpr std::size_t kMainPlanes = 12;  // largest planes whose normals may be the vertical
constexpr double kLeastConeDeg = 12.0;   // a scanner's blind cone is wider
constexpr double kLeadDeg = 6.0;         // by which its cone must be wider than any other's
constexpr double kStrayShare = 0.0005;   // of the points that may lie in the cone: feet, reflections
constexpr double kLowPathM = 1.0;
constexpr double kHighPathM = 5.0;
constexpr double kPathSpreadM = 0.6;

Scan part_of(const Scan& scan) {
  std::vector<std::uint32_t> indices;
  const std::size_t step = 1 + scan.size() / kLooked;
  for (std::size_t i = 0; i < scan.size(); i += step) indices.push_back(static_cast<std::uint32_t>(i));
  return subset(scan, indices);
}

/// Unit normals of the largest planes, both signs, no two alike.
std::vector<Vector3d> main_directions(const Features& features) {
  std::vector<const PlanarPolygon*> planes;
  for (const PlanarPolygon& plane : features.planes) planes.push_back(&plane);
  std::stable_sort(planes.begin(), planes.end(),
                   [](const PlanarPolygon* a, const PlanarPolygon* b) { return a->area_m2 > b->area_m2; });
  if (planes.size() > kMainPlanes) planes.resize(kMainPlanes);
  std::vector<Vector3d> directions;
  for (const PlanarPolygon* plane : planes) {
    for (const double sign : {1.0, -1.0}) {
      const Vector3d d = sign * plane->plane.normal;
      const bool known = std::any_of(directions.begin(), directions.end(),
                                     [&](const Vector3d& other) { return other.dot(d) > 0.995; });
      if (!known) directions.push_back(d);
    }
  }
  return directions;
}

/// Half the opening angle of the cone about `axis` that holds hardly a point.
double empty_cone_rad(const Scan& scan, const Vector3d& axis) {
  std::vector<double> cosines;
  cosines.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d ray = scan.points[i] - scan.centre(i);
    const double range = ray.norm();
    if (range > 0.05) cosines.push_back(ray.dot(axis) / range);
  }
  if (cosines.size() < 100) return 0.0;
  const auto strays = static_cast<std::ptrdiff_t>(kStrayShare * static_cast<double>(cosines.size()));
  std::nth_element(cosines.begin(), cosines.begin() + strays, cosines.end(), std::greater<>());
  return std::acos(std::clamp(cosines[static_cast<std::size_t>(strays)], -1.0, 1.0));
}

std::optional<Vector3d> up_of_station(const Scan& scan, const std::vector<Vector3d>& directions) {
  double widest = 0.0;
  double next = 0.0;
  Vector3d up = Vector3d::UnitZ();
  for (const Vector3d& direction : directions) {
    const double cone = empty_cone_rad(scan, -direction);
    if (cone > widest) {
      if (up.dot(direction) < 0.98) next = widest;
      widest = cone;
      up = direction;
    } else if (up.dot(direction) < 0.98) {
      next = std::max(next, cone);
    }
  }
  if (widest < radians(kLeastConeDeg) || widest - next < radians(kLeadDeg)) return std::nullopt;
  return up;
}

std::optional<Vector3d> up_of_vehicle(const Scan& scan, const Features& features) {
  std::size_t most = 0;
  std::optional<Vector3d> up;
  for (const PlanarPolygon& plane : features.planes) {
    if (!plane.oriented || plane.inliers <= most) continue;
    std::vector<double> heights;
    for (std::size_t i = 0; i < scan.size(); i += 1 + scan.size() / 2000)
      heights.push_back(plane.plane.signed_distance(scan.centre(i)));
    std::sort(heights.begin(), heights.end());
    const double low = heights[heights.size() / 20];
    const double high = heights[heights.size() - 1 - heights.size() / 20];
    if (low < kLowPathM || high > kHighPathM || high - low > kPathSpreadM) continue;
    // The ground lies on both sides of the path and under it, a wall beside it on one side only.
    Vector3d middle = Vector3d::Zero();
    for (std::size_t i = 0; i < scan.size(); i += 1 + scan.size() / 2000) middle += scan.centre(i);
    middle /= static_cast<double>(heights.size());
    const Vector3d foot = plane.plane.project(middle);
    double nearest = 1e9;
    for (const SurfaceSample& sample : features.samples) {
      if (sample.plane == static_cast<std::int32_t>(&plane - features.planes.data()))
        nearest = std::min(nearest, (sample.mean - foot).norm());
    }
    if (nearest > kHighPathM) continue;
    most = plane.inliers;
    up = plane.plane.normal;
  }
  return up;
}

}  // namespace

std::optional<Vector3d> find_scanner_up(const Scan& scan, Monitor& monitor) {
  if (!scan.centre_known() || scan.size() < 1000) return std::nullopt;
  const Scan part = part_of(scan);
  ExtractOptions options;
  options.interior.enabled = false;
  const Features features = extract_features(part, options, monitor).features;
  return scan.mobile() ? up_of_vehicle(part, features) : up_of_station(part, main_directions(features));
}

}  // namespace limen
