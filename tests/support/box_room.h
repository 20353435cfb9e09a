// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A room made of boxes, and what a scanner sees of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "limen/base/random.h"
#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

namespace limen {

struct Box {
  Vector3d low;
  Vector3d high;
  BimKind kind = BimKind::wall;
};

/// One face of a box: across `axis`, at its high end or its low end.
inline BimFace face_of(const Box& box, int axis, bool high, std::int32_t element) {
  BimFace face;
  face.plane.normal = (high ? 1.0 : -1.0) * Vector3d::Unit(axis);
  const Vector3d corner = high ? box.high : box.low;
  face.plane.offset = face.plane.normal.dot(corner);
  face.frame = make_frame(face.plane, corner);
  if (face.frame.u.cross(face.frame.v).dot(face.plane.normal) < 0.0) face.frame.u = -face.frame.u;
  const Vector2d a = face.frame.to_plane(box.low);
  const Vector2d b = face.frame.to_plane(box.high);
  const Vector2d low = a.cwiseMin(b);
  const Vector2d top = a.cwiseMax(b);
  face.outline.outer = {low, {top.x(), low.y()}, top, {low.x(), top.y()}};
  face.area_m2 = (top - low).prod();
  face.element = element;
  return face;
}

inline BimModel model_of(const std::vector<Box>& boxes) {
  BimModel model;
  model.name = "boxes";
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    model.elements.push_back({boxes[k].kind, "Box", "", "box " + std::to_string(k), "", 0});
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool high : {false, true})
        model.faces.push_back(face_of(boxes[k], axis, high, static_cast<std::int32_t>(k)));
    }
  }
  return model;
}

/// Range at which a ray enters a box, or infinity.
inline double range_to(const Box& box, const Vector3d& from, const Vector3d& direction) {
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double a = (box.low[k] - from[k]) / direction[k];
    const double b = (box.high[k] - from[k]) / direction[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave && enter > 0.0 ? enter : std::numeric_limits<double>::infinity();
}

/// A room of 6 x 5 x 3 m: floor, ceiling, four walls, a column, a cupboard against the north wall.
inline std::vector<Box> room() {
  return {{{-0.2, -0.2, -0.3}, {6.2, 5.2, 0.0}, BimKind::slab},
          {{-0.2, -0.2, 3.0}, {6.2, 5.2, 3.3}, BimKind::slab},
          {{-0.2, -0.2, 0.0}, {0.0, 5.2, 3.0}, BimKind::wall},
          {{6.0, -0.2, 0.0}, {6.2, 5.2, 3.0}, BimKind::wall},
          {{0.0, -0.2, 0.0}, {6.0, 0.0, 3.0}, BimKind::wall},
          {{0.0, 5.0, 0.0}, {6.0, 5.2, 3.0}, BimKind::wall},
          {{4.3, 1.2, 0.0}, {4.7, 1.6, 3.0}, BimKind::column},
          {{1.5, 4.4, 0.0}, {2.7, 5.0, 1.9}, BimKind::furniture}};
}

/// What a scanner at `centre` sees of the boxes: rays evenly over the sphere, 3 mm of noise.
inline Scan scan_of(const std::vector<Box>& boxes, const Vector3d& centre, std::size_t rays,
                    std::uint64_t seed = 9) {
  RandomStream random(seed);
  Scan scan;
  scan.name = "made up";
  scan.centres = {centre};
  for (std::size_t i = 0; i < rays; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(rays);
    const double angle = 2.399963229728653 * static_cast<double>(i);  // the golden angle
    const double r = std::sqrt(1.0 - z * z);
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    double range = std::numeric_limits<double>::infinity();
    for (const Box& box : boxes) range = std::min(range, range_to(box, centre, direction));
    if (std::isfinite(range))
      scan.points.emplace_back(centre + (range + 0.003 * random.normal()) * direction);
  }
  return scan;
}

inline Box shifted(Box box, const Vector3d& shift) {
  box.low += shift;
  box.high += shift;
  return box;
}

inline const Vector3d kEye(3.0, 2.6, 1.5);
inline constexpr std::size_t kRays = 120000;

}  // namespace limen
