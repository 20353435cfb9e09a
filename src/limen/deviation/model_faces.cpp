// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/model_faces.h"

#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// The vector area of a closed surface is 0; of it, this share may be left by rounding and slivers.
constexpr double kClosed = 0.01;
constexpr double kSmallestPaneM2 = 0.05;
constexpr double kThickestPaneM = 0.03;  // door leaves are thicker
constexpr double kParallel = 0.999;

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

/// Middle of the box round a face's outline.
Vector3d middle_of(const BimFace& face) {
  const auto [low, high] = box_of(face.outline.outer);
  return face.frame.to_space(0.5 * (low + high));
}

/// Whether two faces of one element are the two sides of something thin.
bool are_thin(const BimFace& a, const BimFace& b) {
  if (b.area_m2 < kSmallestPaneM2 || a.plane.normal.dot(b.plane.normal) > -kParallel) return false;
  const double thickness = a.plane.signed_distance(b.plane.project(a.plane.project(middle_of(b))));
  return thickness < 0.0 && -thickness <= kThickestPaneM &&
         contains(a.outline, a.frame.to_plane(middle_of(b)));
}

/// Faces of doors that are the sides of sheets thinner than a leaf: glass, most likely.
std::vector<char> panes_of(const BimModel& model) {
  std::vector<char> panes(model.faces.size(), 0);
  for (std::size_t i = 0; i < panes.size(); ++i) {
    const BimFace& face = model.faces[i];
    if (model.elements[static_cast<std::size_t>(face.element)].kind != BimKind::door) continue;
    if (face.area_m2 < kSmallestPaneM2) continue;
    for (std::size_t j = i + 1; j < panes.size() && model.faces[j].element == face.element; ++j) {
      if (are_thin(face, model.faces[j])) panes[i] = panes[j] = 1;
    }
  }
  return panes;
}

}  // namespace

ModelFaces faces_of(const BimModel& model) {
  const std::vector<bool> closed = closed_elements(model);
  const std::vector<char> panes = panes_of(model);
  ModelFaces all;
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    const BimFace& face = model.faces[i];
    all.faces.push_back({face.plane, face.frame, face.outline});
    all.elements.push_back(face.element);
    all.panes.push_back(panes[i]);
    if (closed[static_cast<std::size_t>(face.element)]) continue;
    all.faces.push_back(flipped(all.faces.back()));
    all.elements.push_back(face.element);
    all.panes.push_back(panes[i]);
  }
  return all;
}

}  // namespace limen
