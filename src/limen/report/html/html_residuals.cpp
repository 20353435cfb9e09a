// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_residuals.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limen/base/parallel.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr std::size_t kMostPlanes = 255;
constexpr std::size_t kGrain = 8192;
constexpr double kBorderM = 0.05;  // points at the border of an outline still belong to it
constexpr double kLeastNearM = 0.015;

/// A plane made ready to be asked by many points.
struct NearPlane {
  const PlanarPolygon* polygon = nullptr;
  Box2 box;
  double near_m = 0.0;
};

std::vector<NearPlane> near_planes(const Features& features) {
  std::vector<NearPlane> planes;
  for (const PlanarPolygon& polygon : features.planes) {
    if (planes.size() == kMostPlanes) break;
    NearPlane plane{&polygon, box_of(polygon.parts), 0.0};
    plane.near_m = std::max({kLeastNearM, 3.0 * polygon.rms_m, features.inlier_threshold_m});
    plane.box.low.array() -= kBorderM;
    plane.box.high.array() += kBorderM;
    planes.push_back(plane);
  }
  return planes;
}

/// Inside an outline, or so near its border that a turn of a few centimetres is inside.
bool on_polygon(const PlanarPolygon& polygon, const Vector2d& p) {
  static const std::array<Vector2d, 5> places = {Vector2d(0, 0), Vector2d(kBorderM, 0),
                                                 Vector2d(-kBorderM, 0), Vector2d(0, kBorderM),
                                                 Vector2d(0, -kBorderM)};
  return std::any_of(polygon.parts.begin(), polygon.parts.end(), [&p](const Polygon& part) {
    return std::any_of(places.begin(), places.end(),
                       [&](const Vector2d& shift) { return contains(part, p + shift); });
  });
}

std::uint8_t plane_of(const Vector3d& x, const std::vector<NearPlane>& planes) {
  std::uint8_t best = 0;
  double least = 1e300;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const NearPlane& plane = planes[k];
    const double distance = std::abs(plane.polygon->plane.signed_distance(x));
    if (distance > plane.near_m || distance >= least) continue;
    const Vector2d p = plane.polygon->frame.to_plane(x);
    if (!plane.box.contains(p) || !on_polygon(*plane.polygon, p)) continue;
    least = distance;
    best = static_cast<std::uint8_t>(k + 1);
  }
  return best;
}

/// The target plane that a source plane was matched with, the one of most overlap; source's local frame.
struct MatchedPlane {
  bool matched = false;
  double overlap_m2 = 0.0;
  Plane target;
};

std::vector<MatchedPlane> matched_planes(const ReportScene& scene, const RegistrationResult& result) {
  const Rigid3 source_from_target =
      inverse(to_local(result.best.target_from_source, scene.source.origin, scene.target.origin));
  std::vector<MatchedPlane> list(kMostPlanes + 1);
  for (const PlaneMatch& match : result.matches) {
    if (match.source < 0 || match.source >= static_cast<int>(kMostPlanes) || match.target < 0) continue;
    const auto target = static_cast<std::size_t>(match.target);
    if (target >= scene.target.pictured.features.planes.size()) continue;
    MatchedPlane& known = list[static_cast<std::size_t>(match.source) + 1];
    if (known.matched && known.overlap_m2 >= match.overlap_m2) continue;
    known = {true, match.overlap_m2,
             transformed(source_from_target, scene.target.pictured.features.planes[target].plane)};
  }
  return list;
}

/// A round number of millimetres that holds most of the distances.
double range_for(double rms_m) {
  for (const double range : {0.005, 0.01, 0.02, 0.05, 0.1}) {
    if (range >= 2.5 * rms_m) return range;
  }
  return 0.2;
}

}  // namespace

std::vector<std::uint8_t> plane_of_points(const SceneSide& side) {
  const std::vector<NearPlane> planes = near_planes(side.pictured.features);
  std::vector<std::uint8_t> labels(side.points.size(), 0);
  parallel_for(side.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) labels[i] = plane_of(side.points[i], planes);
  });
  return labels;
}

PointResiduals point_residuals(const ReportScene& scene, const RegistrationResult& result,
                               const std::vector<std::uint8_t>& plane_of_source) {
  const std::vector<MatchedPlane> matched = matched_planes(scene, result);
  PointResiduals residuals;
  residuals.range_m = range_for(result.best.rms_m);
  residuals.values.assign(scene.source.points.size(), 0);
  for (std::size_t i = 0; i < plane_of_source.size(); ++i) {
    const MatchedPlane& plane = matched[plane_of_source[i]];
    if (!plane.matched) continue;
    const double distance = plane.target.signed_distance(scene.source.points[i]);
    const double share = std::clamp(distance / residuals.range_m, -1.0, 1.0);
    residuals.values[i] = static_cast<std::uint8_t>(std::lround(128.0 + 127.0 * share));
  }
  return residuals;
}

}  // namespace limen
