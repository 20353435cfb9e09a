// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/opening_parts.h"

#include <cmath>
#include <numbers>

namespace limen {
namespace {

using Corners = std::array<Vector3d, 4>;

std::vector<Vector3d> ring_of(const Corners& corners) {
  return {corners.begin(), corners.end()};
}

Corners corners_at(const OpeningShape& s, double depth, double splay) {
  return {s.at(-splay, 0.0, depth), s.at(s.width_m + splay, 0.0, depth),
          s.at(s.width_m + splay, s.height_m + splay, depth), s.at(-splay, s.height_m + splay, depth)};
}

/// Four faces that look into the passage between two rings.
void add_reveals(Mesh& mesh, const Corners& outer, const Corners& inner, int id) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    mesh.add_polygon({outer[i], outer[next], inner[next], inner[i]}, surface_of(Element::reveal, id));
  }
}

/// A bar of the rectangle `r` of the outer face, from `depth0` to `depth1` behind it.
void add_bar(Mesh& mesh, const OpeningShape& s, const PanelRect& r, const Vector2d& depths, Element element) {
  const Vector3d base = s.at(0.5 * (r.u0 + r.u1), r.v0, 0.5 * depths.sum());
  mesh.add_box({base, std::atan2(s.outer.u.y(), s.outer.u.x())},
               {r.u1 - r.u0, depths.y() - depths.x(), r.v1 - r.v0}, surface_of(element, s.id));
}

void add_window_frame(Mesh& mesh, const OpeningShape& s) {
  const Vector2d depths(s.frame_depth_m, s.frame_depth_m + 0.06);
  const double w = s.width_m;
  const double h = s.height_m;
  const double bar = s.bar_m;
  add_bar(mesh, s, {0.0, 0.0, w, bar}, depths, Element::frame);
  add_bar(mesh, s, {0.0, h - bar, w, h}, depths, Element::frame);
  add_bar(mesh, s, {0.0, bar, bar, h - bar}, depths, Element::frame);
  add_bar(mesh, s, {w - bar, bar, w, h - bar}, depths, Element::frame);
  for (int i = 1; i <= s.mullions; ++i) {
    const double u = w * i / (s.mullions + 1);
    add_bar(mesh, s, {u - 0.5 * bar, bar, u + 0.5 * bar, h - bar}, depths, Element::mullion);
  }
  for (int i = 1; i <= s.transoms; ++i) {
    const double v = bar + (h - 2.0 * bar) * (0.35 + 0.4 * i) / (0.35 + 0.4 * s.transoms + 0.25);
    add_bar(mesh, s, {bar, v - 0.4 * bar, w - bar, v + 0.4 * bar}, depths + Vector2d(0.004, -0.004),
            Element::mullion);
  }
  const double pane = s.frame_depth_m + 0.03;
  mesh.add_sheet({s.at(bar, bar, pane), s.at(w - bar, bar, pane), s.at(w - bar, h - bar, pane),
                  s.at(bar, h - bar, pane)},
                 surface_of(Element::glass, s.id));
}

/// A hanging of cloth in folds, in the room, a hand's breadth from the wall.
void add_curtain(Mesh& mesh, const OpeningShape& s, RandomStream& random) {
  const double u0 = -s.splay_m - 0.2;
  const double u1 = s.width_m + s.splay_m + 0.2;
  const double low = -random.uniform(0.05, 0.3);
  const double high = s.height_m + s.splay_m + 0.12;
  const double depth = s.thickness_m + random.uniform(0.09, 0.16);
  const double fold = random.uniform(0.015, 0.035);
  const double period = random.uniform(0.12, 0.25);
  const double phase = random.uniform(0.0, 6.0);
  Surface cloth = surface_of(Element::curtain, s.id);
  cloth.planar = false;
  const int id = mesh.add_surface(cloth);
  const int strips = std::max(8, static_cast<int>((u1 - u0) / (period / 8.0)));
  const auto point = [&](int i, double v) {
    const double u = u0 + (u1 - u0) * i / strips;
    return s.at(u, v, depth + fold * std::sin(2.0 * std::numbers::pi * u / period + phase));
  };
  for (int i = 0; i < strips; ++i) {
    mesh.add_triangle(point(i, low), point(i + 1, low), point(i + 1, high), id);
    mesh.add_triangle(point(i, low), point(i + 1, high), point(i, high), id);
  }
}

void add_blind(Mesh& mesh, const OpeningShape& s) {
  const double depth = std::min(s.frame_depth_m + 0.09, s.thickness_m - 0.01);
  Surface blind = surface_of(Element::blind, s.id);
  mesh.add_sheet(ring_of(corners_at(s, depth, 0.0)), blind);
}

void add_leaf(Mesh& mesh, const OpeningShape& s) {
  const double width = s.width_m - 0.02;
  const double angle = s.kind == OpeningKind::open_door ? s.leaf_angle_rad : 0.0;
  const double hinge_u = s.hinge_left ? 0.01 : s.width_m - 0.01;
  const double side = s.hinge_left ? 1.0 : -1.0;
  // The leaf turns inwards about its hinge on the inner face.
  const double depth = angle == 0.0 ? s.thickness_m - 0.06 : s.thickness_m + 0.03;
  const Vector3d hinge = s.at(hinge_u, 0.008, depth);
  const Vector3d inwards = -s.outer.u.cross(s.outer.v);
  const Vector3d along = side * std::cos(angle) * s.outer.u + std::sin(angle) * inwards;
  mesh.add_box({hinge + 0.5 * width * along, std::atan2(along.y(), along.x())},
               {width, 0.04, s.height_m - 0.016}, surface_of(Element::door, s.id));
}

}  // namespace

Vector3d OpeningShape::at(double u, double v, double depth_m) const {
  return outer.origin + u * outer.u + v * outer.v - depth_m * outer.u.cross(outer.v);
}

std::array<Vector3d, 4> OpeningShape::outer_corners() const {
  return corners_at(*this, 0.0, 0.0);
}

std::array<Vector3d, 4> OpeningShape::inner_corners() const {
  return corners_at(*this, thickness_m, splay_m);
}

void add_opening_parts(Mesh& mesh, const OpeningShape& s, RandomStream& random) {
  if (s.splay_m > 0.0) {
    const Corners middle = corners_at(s, s.frame_depth_m + 0.06, 0.0);
    add_reveals(mesh, s.outer_corners(), middle, s.id);
    add_reveals(mesh, middle, s.inner_corners(), s.id);
  } else {
    add_reveals(mesh, s.outer_corners(), s.inner_corners(), s.id);
  }
  if (s.kind == OpeningKind::window) {
    add_window_frame(mesh, s);
    if (s.cover == Cover::curtain) add_curtain(mesh, s, random);
    if (s.cover == Cover::blind) add_blind(mesh, s);
    return;
  }
  mesh.add_sheet(ring_of(corners_at(s, 0.5 * s.thickness_m, 0.0)), surface_of(Element::portal, s.id));
  add_leaf(mesh, s);
}

}  // namespace limen
