// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "limen/model/bim_model.h"

// Models of boxes for tests.

namespace limen {

/// Adds the face with the given corners, counter-clockwise seen from outside.
inline void add_face(BimModel& model, const std::vector<Vector3d>& corners, std::int32_t element) {
  BimFace face;
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  face.plane = {normal, normal.dot(corners[0])};
  face.frame = make_frame(face.plane, corners[0]);
  for (const Vector3d& corner : corners) face.outline.outer.push_back(face.frame.to_plane(corner));
  face.area_m2 = area(face.outline);
  face.element = element;
  model.faces.push_back(std::move(face));
}

/// Adds a closed box as one element and returns its index.
inline std::int32_t add_box(BimModel& model, BimKind kind, const Vector3d& low, const Vector3d& high) {
  const auto element = static_cast<std::int32_t>(model.elements.size());
  model.elements.push_back(
      {kind, std::string("Ifc") + to_string(kind), "", "box " + std::to_string(element), "", 0});
  const auto at = [&](int x, int y, int z) {
    return Vector3d(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  add_face(model, {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)}, element);
  add_face(model, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}, element);
  add_face(model, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)}, element);
  add_face(model, {at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)}, element);
  add_face(model, {at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)}, element);
  add_face(model, {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}, element);
  return element;
}

/// A row of rooms, 3 m high inside, 4 m deep, `widths` wide, with walls of 0.2 m round them, a floor and a
/// ceiling of 0.2 m; the first room's inner corner is the origin. Every room has a column of its own place
/// along the back wall (0: none), 0.3 m x 0.3 m.
inline BimModel row_of_rooms(const std::vector<double>& widths, const std::vector<double>& columns = {}) {
  BimModel model;
  model.name = "row";
  model.schema = "none";
  constexpr double kWall = 0.2;
  constexpr double kDepth = 4.0;
  constexpr double kHeight = 3.0;
  double length = kWall * static_cast<double>(widths.size() - 1);
  for (const double width : widths) length += width;
  add_box(model, BimKind::slab, {-kWall, -kWall, -kWall}, {length + kWall, kDepth + kWall, 0.0});
  add_box(model, BimKind::slab, {-kWall, -kWall, kHeight}, {length + kWall, kDepth + kWall, kHeight + kWall});
  add_box(model, BimKind::wall, {-kWall, -kWall, 0.0}, {length + kWall, 0.0, kHeight});
  add_box(model, BimKind::wall, {-kWall, kDepth, 0.0}, {length + kWall, kDepth + kWall, kHeight});
  double x = 0.0;
  add_box(model, BimKind::wall, {-kWall, 0.0, 0.0}, {0.0, kDepth, kHeight});
  for (std::size_t k = 0; k < widths.size(); ++k) {
    if (k < columns.size() && columns[k] > 0) {
      add_box(model, BimKind::column, {x + columns[k], kDepth - 0.3, 0.0},
              {x + columns[k] + 0.3, kDepth, kHeight});
    }
    x += widths[k];
    add_box(model, BimKind::wall, {x, 0.0, 0.0}, {x + kWall, kDepth, kHeight});
    x += kWall;
  }
  return model;
}

}  // namespace limen
