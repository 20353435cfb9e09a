// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_view.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr std::size_t kEnough = 20000;
constexpr double kCountedMore = 30.0;
constexpr double kEyeM = 1.4;  // above the floor: through windows and doors

/// Box of the central 94 % of the places along each axis.
struct ViewBox {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  [[nodiscard]] double diagonal() const { return (high - low).norm(); }
};

/// Places of a side: its points, else corners of its faces, else ends of its segments.
std::vector<Vector3d> places_of(const SceneSide& side) {
  if (!side.points.empty()) return side.points;
  std::vector<Vector3d> places;
  for (const Triangle3& face : side.faces) places.insert(places.end(), face.begin(), face.end());
  if (!places.empty()) return places;
  for (const Segment& segment : side.pictured.features.segments) {
    places.push_back(segment.a);
    places.push_back(segment.b);
  }
  return places;
}

ViewBox box_around(const std::vector<Vector3d>& places, const Rigid3& view_from_places) {
  ViewBox box;
  if (places.empty()) return box;
  const std::size_t stride = 1 + places.size() / kEnough;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (std::size_t i = 0; i < places.size(); i += stride)
      values.push_back((view_from_places * places[i])[axis]);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() * 3 / 100;
    box.low[axis] = values[cut];
    box.high[axis] = values[values.size() - 1 - cut];
  }
  return box;
}

/// Adds a wall's direction in the plan, four times the angle, so that walls at right angles count as one
/// direction.
void add_direction(const Vector3d& normal, double area_m2, const Vector3d& up, const Matrix3d& level,
                   Vector2d& sum) {
  if (std::abs(normal.dot(up)) > 0.2) return;
  const Vector3d flat = level * normal;
  const double angle = 4.0 * std::atan2(flat.y(), flat.x());
  sum += area_m2 * Vector2d(std::cos(angle), std::sin(angle));
}

/// Turned so that the walls run along the axes, the side's own axes where it has no walls. `counted`: planes
/// that count more than all others.
Matrix3d along_walls(const SceneSide& side, const std::vector<int>& counted = {}) {
  const Vector3d up = side.pictured.up;
  const Vector3d near_x = std::abs(up.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  Matrix3d level;
  level.row(2) = up.transpose();
  level.row(0) = (near_x - up.dot(near_x) * up).normalized().transpose();
  level.row(1) = up.cross(Vector3d(level.row(0).transpose())).transpose();
  Vector2d sum = Vector2d::Zero();
  for (const PlanarPolygon& polygon : side.pictured.features.planes)
    add_direction(polygon.plane.normal, polygon.area_m2, up, level, sum);
  for (const int index : counted) {
    const auto& planes = side.pictured.features.planes;
    if (index < 0 || static_cast<std::size_t>(index) >= planes.size()) continue;
    const PlanarPolygon& polygon = planes[static_cast<std::size_t>(index)];
    add_direction(polygon.plane.normal, kCountedMore * polygon.area_m2, up, level, sum);
  }
  for (const Segment& segment : side.pictured.features.segments)
    add_direction(segment.direction(), segment.length(), up, level, sum);
  if (sum.norm() < 1e-6) return level;
  const double angle = std::atan2(sum.y(), sum.x()) / 4.0;
  return rotation_exp(Vector3d(0, 0, -angle)) * level;
}

/// Sections go through the first opening that both sides saw, else through the middle at eye height.
Vector3d place_of_cut(const ReportScene& scene, const RegistrationResult& result, const SceneView& view) {
  Vector3d cut = 0.5 * (view.low + view.high);
  cut.z() = view.low.z() + std::min(kEyeM, 0.5 * (view.high.z() - view.low.z()));
  const std::vector<Opening>& openings = scene.target.pictured.features.openings;
  for (const MatchedOpenings& match : result.openings) {
    if (match.target < 0 || static_cast<std::size_t>(match.target) >= openings.size()) continue;
    const Vector3d at = view.view_from_target * openings[static_cast<std::size_t>(match.target)].middle();
    if (((at - view.low).array() > 0).all() && ((view.high - at).array() > 0).all()) return at;
  }
  return cut;
}

/// Where nothing was found the source is beside the target, on the right.
Rigid3 beside(const ReportScene& scene, const Matrix3d& view_from_target) {
  const ViewBox target = box_around(places_of(scene.target), {view_from_target, Vector3d::Zero()});
  const Matrix3d view_from_source = along_walls(scene.source);
  const ViewBox source = box_around(places_of(scene.source), {view_from_source, Vector3d::Zero()});
  const double gap = 0.08 * (target.diagonal() + source.diagonal());
  const Vector3d shift = Vector3d(target.high.x() + gap - source.low.x(),
                                  0.5 * (target.low.y() + target.high.y() - source.low.y() - source.high.y()),
                                  target.low.z() - source.low.z());
  const Matrix3d back = view_from_target.transpose();
  return {back * view_from_source, back * shift};
}

}  // namespace

SceneView make_view(const ReportScene& scene, const RegistrationResult& result) {
  SceneView view;
  std::vector<int> matched;
  for (const PlaneMatch& match : result.matches) matched.push_back(match.target);
  view.view_from_target = along_walls(scene.target, matched);
  view.matched = result.outcome != Outcome::no_match;
  view.target_from_source =
      view.matched ? to_local(result.best.target_from_source, scene.source.origin, scene.target.origin)
                   : beside(scene, view.view_from_target);
  const Rigid3 view_pose{view.view_from_target, Vector3d::Zero()};
  const ViewBox target = box_around(places_of(scene.target), view_pose);
  const ViewBox source = box_around(places_of(scene.source), view_pose * view.target_from_source);
  // The smaller side is what was sought; of the larger one its surroundings.
  ViewBox focus = source.diagonal() <= target.diagonal() ? source : target;
  if (!view.matched) focus = {source.low.cwiseMin(target.low), source.high.cwiseMax(target.high)};
  const double margin = 0.08 * focus.diagonal() + 0.3;
  view.low = focus.low;
  view.high = focus.high;
  view.cut = place_of_cut(scene, result, view);
  view.low.array() -= margin;
  view.high.array() += margin;
  return view;
}

}  // namespace limen
