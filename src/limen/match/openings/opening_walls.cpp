// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/opening_walls.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kSameWallDeg = 5.0;  // openings whose planes differ by less, and
constexpr double kSameWallM = 0.3;    // lie nearer than this to one plane, are of one wall
constexpr double kMaxTiltSine = 0.5;  // planes that lean by more than 30 degrees are no walls

Vector3d right_of(const Opening& opening) {
  return opening.corners[1] - opening.corners[0] + opening.corners[2] - opening.corners[3];
}

Vector3d up_of(const Opening& opening) {
  return opening.corners[3] - opening.corners[0] + opening.corners[2] - opening.corners[1];
}

/// The normal towards the scanner: the plane's where it is known, with the sign that the corners' order
/// gives.
Vector3d normal_of(const Features& features, const Opening& opening) {
  const Vector3d by_corners = right_of(opening).cross(up_of(opening));
  if (!(by_corners.norm() > 1e-9)) return Vector3d::Zero();
  if (opening.facade < 0 || static_cast<std::size_t>(opening.facade) >= features.planes.size()) {
    return by_corners.normalized();
  }
  const Vector3d& normal = features.planes[static_cast<std::size_t>(opening.facade)].plane.normal;
  return normal.dot(by_corners) < 0.0 ? Vector3d(-normal) : normal;
}

/// Openings of one wall before it has a frame.
struct Group {
  Vector3d normal = Vector3d::Zero();  // of its first opening
  Vector3d point = Vector3d::Zero();
  std::vector<int> openings;
};

std::vector<Group> group_by_wall(const Features& features, const std::optional<Vector3d>& up) {
  const double min_cosine = std::cos(radians(kSameWallDeg));
  std::vector<Group> groups;
  for (std::size_t i = 0; i < features.openings.size(); ++i) {
    const Opening& opening = features.openings[i];
    const Vector3d normal = normal_of(features, opening);
    if (normal.isZero()) continue;
    if (up && std::abs(normal.dot(*up)) > kMaxTiltSine) continue;
    const Vector3d centre = opening.middle();
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return group.normal.dot(normal) > min_cosine && std::abs(normal.dot(centre - group.point)) < kSameWallM;
    });
    if (same != groups.end()) {
      same->openings.push_back(static_cast<int>(i));
    } else {
      groups.push_back({normal, centre, {static_cast<int>(i)}});
    }
  }
  return groups;
}

/// The plane among the openings' with the largest area, or -1.
int largest_plane(const Features& features, const Group& group) {
  int best = -1;
  for (const int i : group.openings) {
    const int facade = features.openings[static_cast<std::size_t>(i)].facade;
    if (facade < 0 || static_cast<std::size_t>(facade) >= features.planes.size()) continue;
    const auto area = [&](int k) { return features.planes[static_cast<std::size_t>(k)].area_m2; };
    if (best < 0 || area(facade) > area(best)) best = facade;
  }
  return best;
}

PlaneFrame frame_of(const Features& features, const Group& group, int facade,
                    const std::optional<Vector3d>& known_up) {
  Vector3d origin = Vector3d::Zero();
  Vector3d up = Vector3d::Zero();
  Vector3d normal = group.normal;
  for (const int i : group.openings) {
    const Opening& opening = features.openings[static_cast<std::size_t>(i)];
    origin += opening.middle() / static_cast<double>(group.openings.size());
    up += up_of(opening);
  }
  if (facade >= 0) {
    const Plane& plane = features.planes[static_cast<std::size_t>(facade)].plane;
    normal = plane.normal.dot(normal) < 0.0 ? Vector3d(-plane.normal) : plane.normal;
    origin = plane.project(origin);
  }
  if (known_up) {  // the wall is taken for plumb
    up = *known_up;
    normal = (normal - normal.dot(up) * up).normalized();
  } else {
    up = (up - up.dot(normal) * normal).normalized();
  }
  return {origin, up.cross(normal), up};
}

WallRectangle rectangle_of(const Opening& opening, int index, const PlaneFrame& frame) {
  std::array<Vector2d, 4> corner;
  for (std::size_t k = 0; k < 4; ++k) corner[k] = frame.to_plane(opening.corners[k]);
  WallRectangle rectangle;
  rectangle.opening = index;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector2d middle = 0.5 * (corner[k] + corner[(k + 1) % 4]);
    rectangle.edge[k] = k % 2 == 0 ? middle.y() : middle.x();
    rectangle.sigma_m[k] = opening.edge_sigma_m[k];
  }
  return rectangle;
}

bool any_edge_seen(const WallRectangle& rectangle) {
  return rectangle.seen(0) || rectangle.seen(1) || rectangle.seen(2) || rectangle.seen(3);
}

}  // namespace

std::vector<WallWithOpenings> walls_with_openings(const Features& features,
                                                  const std::optional<Vector3d>& up) {
  std::vector<WallWithOpenings> walls;
  for (const Group& group : group_by_wall(features, up)) {
    WallWithOpenings wall;
    wall.facade = largest_plane(features, group);
    wall.frame = frame_of(features, group, wall.facade, up);
    for (const int i : group.openings) {
      const WallRectangle rectangle =
          rectangle_of(features.openings[static_cast<std::size_t>(i)], i, wall.frame);
      if (any_edge_seen(rectangle)) wall.rectangles.push_back(rectangle);
    }
    if (!wall.rectangles.empty()) walls.push_back(std::move(wall));
  }
  return walls;
}

WallRectangle seen_from_behind(const WallRectangle& rectangle) {
  WallRectangle result = rectangle;
  result.edge[1] = -rectangle.edge[3];
  result.edge[3] = -rectangle.edge[1];
  result.sigma_m[1] = rectangle.sigma_m[3];
  result.sigma_m[3] = rectangle.sigma_m[1];
  return result;
}

Segment edge_segment(const WallWithOpenings& wall, const WallRectangle& rectangle, std::size_t k) {
  const auto& e = rectangle.edge;
  if (k % 2 == 0) {
    return {wall.frame.to_space(Vector2d(e[3], e[k])), wall.frame.to_space(Vector2d(e[1], e[k]))};
  }
  return {wall.frame.to_space(Vector2d(e[k], e[0])), wall.frame.to_space(Vector2d(e[k], e[2]))};
}

std::vector<Segment> seen_edges(const WallWithOpenings& wall) {
  std::vector<Segment> edges;
  for (const WallRectangle& rectangle : wall.rectangles) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (rectangle.seen(k)) edges.push_back(edge_segment(wall, rectangle, k));
    }
  }
  return edges;
}

}  // namespace limen
