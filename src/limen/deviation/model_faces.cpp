// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/model_faces.h"

#include <algorithm>

namespace limen {
namespace {

/// The vector area of a closed surface is 0; of it, this share may be left by rounding and slivers.
constexpr double kClosed = 0.01;

Ring mirrored(const Ring& ring) {
  Ring turned;
  for (auto it = ring.rbegin(); it != ring.rend(); ++it) turned.emplace_back(-it->x(), it->y());
  return turned;
}

FlatFace flipped(const FlatFace& face) {
  FlatFace back;
  back.plane = face.plane.flipped();
  back.frame = {face.frame.origin, -face.frame.u, face.frame.v};
  back.outline.outer = mirrored(face.outline.outer);
  for (const Ring& hole : face.outline.holes) back.outline.holes.push_back(mirrored(hole));
  return back;
}

/// Which elements are closed solids.
std::vector<bool> closed_elements(const BimModel& model) {
  std::vector<Vector3d> sums(model.elements.size(), Vector3d::Zero());
  std::vector<double> areas(model.elements.size(), 0.0);
  for (const BimFace& face : model.faces) {
    sums[static_cast<std::size_t>(face.element)] += face.area_m2 * face.plane.normal;
    areas[static_cast<std::size_t>(face.element)] += face.area_m2;
  }
  std::vector<bool> closed;
  for (std::size_t k = 0; k < sums.size(); ++k) closed.push_back(sums[k].norm() <= kClosed * areas[k]);
  return closed;
}

}  // namespace

ModelFaces faces_of(const BimModel& model) {
  const std::vector<bool> closed = closed_elements(model);
  ModelFaces all;
  for (const BimFace& face : model.faces) {
    all.faces.push_back({face.plane, face.frame, face.outline});
    all.elements.push_back(face.element);
    if (closed[static_cast<std::size_t>(face.element)]) continue;
    all.faces.push_back(flipped(all.faces.back()));
    all.elements.push_back(face.element);
  }
  return all;
}

}  // namespace limen
