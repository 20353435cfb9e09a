// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "limen/base/random.h"
#include "limen/model/features.h"

// For tests: features of a box-shaped building with windows, as a scanner inside or outside would give them,
// written down from the geometry instead of measured.

namespace limen::synthetic {

/// A window in a wall of the building: seen from outside, metres from the left end of the wall and above its
/// foot.
struct Window {
  double left = 0.0;
  double bottom = 1.0;
  double width = 1.2;
  double height = 1.5;
};

/// An outer wall: its foot runs from `start` to the right (seen from outside) along `right`.
struct Wall {
  Vector3d start = Vector3d::Zero();
  Vector3d right = Vector3d::UnitX();
  double width = 10.0;
  double height = 9.0;
  std::vector<Window> windows;

  [[nodiscard]] Vector3d outward() const { return right.cross(Vector3d::UnitZ()); }
};

/// How a scan sees them.
struct WallSight {
  bool inside = false;
  double thickness_m = 0.4;  ///< of all walls
  double noise_m = 0.0;      ///< of every edge
  double splay_m = 0.0;      ///< inside, windows are wider by this on either side
  std::uint64_t seed = 1;
};

/// A rectangle standing on `start`, `right` and up, as one plane facing its scanner.
inline PlanarPolygon rectangle(const Vector3d& start, const Vector3d& right, const Vector3d& up, double width,
                               double height) {
  PlanarPolygon polygon;
  polygon.frame = {start, right, up};
  polygon.plane.normal = right.cross(up);
  polygon.plane.offset = polygon.plane.normal.dot(start);
  polygon.parts.push_back({{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}, {}});
  polygon.area_m2 = width * height;
  polygon.centroid = start + 0.5 * width * right + 0.5 * height * up;
  polygon.inliers = static_cast<std::size_t>(1000.0 * polygon.area_m2);
  polygon.rms_m = 0.003;
  polygon.oriented = true;
  return polygon;
}

inline Opening opening_of(const Wall& wall, const Window& window, const WallSight& sight,
                          RandomStream& random) {
  const Vector3d up = Vector3d::UnitZ();
  const double splay = sight.inside ? sight.splay_m : 0.0;
  const double left = window.left - splay + sight.noise_m * random.normal();
  const double right = window.left + window.width + splay + sight.noise_m * random.normal();
  const double bottom = window.bottom + sight.noise_m * random.normal();
  const double top = window.bottom + window.height + sight.noise_m * random.normal();
  const Vector3d face = wall.start - (sight.inside ? sight.thickness_m : 0.0) * wall.outward();
  const auto at = [&](double u, double v) { return Vector3d(face + u * wall.right + v * up); };
  Opening opening;
  const std::array<Vector3d, 4> corners =
      sight.inside
          ? std::array<Vector3d, 4>{at(right, bottom), at(left, bottom), at(left, top), at(right, top)}
          : std::array<Vector3d, 4>{at(left, bottom), at(right, bottom), at(right, top), at(left, top)};
  std::copy(corners.begin(), corners.end(), opening.corners);
  std::fill(std::begin(opening.edge_sigma_m), std::end(opening.edge_sigma_m), 0.01);
  opening.evidence = 500;
  return opening;
}

/// A wall with all its windows, added to what a scan has.
inline void add_wall(Features& features, const Wall& wall, const WallSight& sight) {
  RandomStream random(sight.seed, features.planes.size());
  const Vector3d up = Vector3d::UnitZ();
  if (sight.inside) {
    const Vector3d start = wall.start - sight.thickness_m * wall.outward() + wall.width * wall.right;
    features.planes.push_back(rectangle(start, -wall.right, up, wall.width, wall.height));
  } else {
    features.planes.push_back(rectangle(wall.start, wall.right, up, wall.width, wall.height));
  }
  for (const Window& window : wall.windows) {
    features.openings.push_back(opening_of(wall, window, sight, random));
    features.openings.back().facade = static_cast<int>(features.planes.size()) - 1;
  }
}

/// The same features in another frame.
inline Features moved(const Rigid3& pose, Features features) {
  for (PlanarPolygon& p : features.planes) {
    p.plane = transformed(pose, p.plane);
    p.frame = {pose * p.frame.origin, pose.rotation * p.frame.u, pose.rotation * p.frame.v};
    p.centroid = pose * p.centroid;
  }
  for (Opening& opening : features.openings) {
    for (Vector3d& corner : opening.corners) corner = pose * corner;
  }
  return features;
}

/// A regular façade: columns x storeys of equal windows.
inline std::vector<Window> grid(int columns, int storeys, double pitch_m = 2.5, double storey_m = 3.0) {
  std::vector<Window> windows;
  for (int s = 0; s < storeys; ++s) {
    for (int c = 0; c < columns; ++c) windows.push_back({1.0 + pitch_m * c, 1.0 + storey_m * s, 1.2, 1.5});
  }
  return windows;
}

/// A façade on which no two windows look alike in their spacing.
inline std::vector<Window> irregular() {
  return {{0.8, 1.0, 1.2, 1.5}, {2.9, 1.0, 1.2, 1.5}, {6.1, 0.9, 1.8, 1.6}, {9.4, 1.0, 1.2, 1.5},
          {0.9, 4.2, 1.2, 1.4}, {3.4, 4.2, 1.0, 1.4}, {6.0, 4.2, 2.0, 1.4}, {10.3, 4.2, 1.0, 1.4}};
}

}  // namespace limen::synthetic
