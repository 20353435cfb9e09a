// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/opening_parts.h"

#include <cmath>
#include <numbers>

#include "limen/base/named.h"

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

/// The outline drawn in by `inset` on all sides.
Ring inset_outline(const OpeningShape& s, double inset) {
  const Vector2d scale(1.0 - 2.0 * inset / s.width_m, 1.0 - 2.0 * inset / s.height_m);
  Ring ring = s.outline();
  for (Vector2d& p : ring) p = Vector2d(inset, inset) + scale.cwiseProduct(p);
  return ring;
}

std::vector<Vector3d> ring_at(const OpeningShape& s, const Ring& ring, double depth) {
  std::vector<Vector3d> placed;
  placed.reserve(ring.size());
  for (const Vector2d& p : ring) placed.push_back(s.at(p.x(), p.y(), depth));
  return placed;
}

/// The height of the upper side of a convex ring at `u`.
double top_at(const Ring& ring, double u) {
  double top = ring[0].y();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& p = ring[i];
    const Vector2d& q = ring[(i + 1) % ring.size()];
    if (std::min(p.x(), q.x()) > u || std::max(p.x(), q.x()) < u || std::abs(q.x() - p.x()) < 1e-9) continue;
    top = std::max(top, p.y() + (q.y() - p.y()) * (u - p.x()) / (q.x() - p.x()));
  }
  return top;
}

/// The reveal of a curved outline: its straight jambs and sill are planes, pieces of a curve are not.
void add_curved_reveals(Mesh& mesh, const OpeningShape& s, const std::vector<Vector3d>& outer,
                        const std::vector<Vector3d>& inner) {
  const Ring ring = s.outline();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    const Vector2d edge = ring[next] - ring[i];
    Surface side = surface_of(Element::reveal, s.id);
    side.planar = std::abs(edge.x()) < 1e-9 || std::abs(edge.y()) < 1e-9;
    mesh.add_polygon({outer[i], outer[next], inner[next], inner[i]}, side);
  }
}

/// A frame that follows the outline: its two faces and the narrow side towards the pane.
void add_curved_frame(Mesh& mesh, const OpeningShape& s) {
  const Ring outer = s.outline();
  const Ring inner = inset_outline(s, s.bar_m);
  const double front = s.frame_depth_m;
  const double back = s.frame_depth_m + 0.06;
  const auto outside = ring_at(s, outer, front);
  const auto inside = ring_at(s, inner, front);
  const auto outside_back = ring_at(s, outer, back);
  const auto inside_back = ring_at(s, inner, back);
  Surface side = surface_of(Element::frame, s.id);
  side.planar = false;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const std::size_t next = (i + 1) % outer.size();
    mesh.add_polygon({outside[i], outside[next], inside[next], inside[i]}, surface_of(Element::frame, s.id));
    mesh.add_polygon({outside_back[next], outside_back[i], inside_back[i], inside_back[next]},
                     surface_of(Element::frame, s.id));
    mesh.add_polygon({inside[i], inside[next], inside_back[next], inside_back[i]}, side);
  }
  for (int i = 1; i <= s.mullions && s.head != HeadForm::round; ++i) {
    const double u = s.width_m * i / (s.mullions + 1);
    const double half = 0.5 * s.bar_m;
    // The bar ends within the frame, under its lower side.
    const double top = std::min(top_at(outer, u - half), top_at(outer, u + half)) - 0.3 * s.bar_m;
    add_bar(mesh, s, {u - half, 0.5 * s.bar_m, u + half, top}, {front + 0.003, back - 0.003},
            Element::mullion);
  }
  mesh.add_sheet(ring_at(s, inner, front + 0.03), surface_of(Element::glass, s.id));
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
  mesh.add_sheet(ring_at(s, s.outline(), depth), blind);
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

/// Points of an ellipse's arc, both ends included.
void append_arc(Ring& ring, const Vector2d& centre, const Vector2d& radii, const Vector2d& angles,
                int pieces) {
  for (int i = 0; i <= pieces; ++i) {
    const double angle = angles.x() + (angles.y() - angles.x()) * i / pieces;
    ring.emplace_back(centre + Vector2d(radii.x() * std::cos(angle), radii.y() * std::sin(angle)));
  }
}

/// Where a line of the drawn opening meets a face as built.
Vector3d on_face(const BuiltOpening& built, const Plane& face, const Vector3d& from, const Vector3d& to) {
  const Vector3d begin = built.map(from);
  const Vector3d way = built.map(to) - begin;
  return begin - face.signed_distance(begin) / face.normal.dot(way) * way;
}

std::vector<Vector3d> on_face(const BuiltOpening& built, const Plane& face, const std::vector<Vector3d>& from,
                              const std::vector<Vector3d>& to) {
  std::vector<Vector3d> ring;
  ring.reserve(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) ring.push_back(on_face(built, face, from[i], to[i]));
  return ring;
}

Corners first_four(const std::vector<Vector3d>& ring) {
  return {ring[0], ring[1], ring[2], ring[3]};
}

/// Where a splayed opening begins to widen.
double splay_depth(const OpeningShape& s) {
  return s.frame_depth_m + 0.06;
}

void add_all_reveals(Mesh& mesh, const OpeningShape& s, const BuiltOpening* built) {
  if (s.head != HeadForm::rectangular)
    return add_curved_reveals(mesh, s, built != nullptr ? built->outer_outline(s) : s.outer_outline(),
                              built != nullptr ? built->inner_outline(s) : s.inner_outline());
  const Corners outer = built != nullptr ? built->outer_corners(s) : s.outer_corners();
  const Corners inner = built != nullptr ? built->inner_corners(s) : s.inner_corners();
  if (s.splay_m <= 0.0) return add_reveals(mesh, outer, inner, s.id);
  Corners middle = corners_at(s, splay_depth(s), 0.0);
  if (built != nullptr)
    for (Vector3d& corner : middle) corner = built->map(corner);
  add_reveals(mesh, outer, middle, s.id);
  add_reveals(mesh, middle, inner, s.id);
}

constexpr int kArcPieces = 16;  // even, so that the highest point of an arch is a corner

}  // namespace

const char* to_string(HeadForm head) {
  static constexpr Named<HeadForm> names[] = {{HeadForm::segmental, "segmental"},
                                              {HeadForm::semicircle, "semicircle"},
                                              {HeadForm::round, "round"},
                                              {HeadForm::rectangular, "rectangular"}};
  return name_of(names, head);
}

Ring OpeningShape::outline() const {
  const double pi = std::numbers::pi;
  const Vector2d half(0.5 * width_m, 0.5 * height_m);
  Ring ring;
  if (head == HeadForm::round) {
    append_arc(ring, half, half, {0.0, 2.0 * pi}, 2 * kArcPieces);
    ring.pop_back();
    return ring;
  }
  ring = {{0.0, 0.0}, {width_m, 0.0}};
  if (head == HeadForm::rectangular) {
    ring.insert(ring.end(), {{width_m, height_m}, {0.0, height_m}});
    return ring;
  }
  const double rise = head == HeadForm::semicircle ? half.x() : rise_m;
  const double radius = 0.5 * (half.x() * half.x() + rise * rise) / rise;
  const double opening = std::asin(std::min(1.0, half.x() / radius));
  append_arc(ring, {half.x(), height_m - radius}, {radius, radius}, {0.5 * pi - opening, 0.5 * pi + opening},
             kArcPieces);
  return ring;
}

std::vector<Vector3d> OpeningShape::outer_outline() const {
  return ring_at(*this, outline(), 0.0);
}

std::vector<Vector3d> OpeningShape::inner_outline() const {
  if (head != HeadForm::rectangular) return ring_at(*this, outline(), thickness_m);
  return ring_of(inner_corners());
}

std::vector<std::array<Vector2d, 3>> spandrels(const Ring& outline, const Vector2d& size) {
  std::vector<std::array<Vector2d, 3>> triangles;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& p = outline[i];
    const Vector2d& q = outline[(i + 1) % outline.size()];
    const Vector2d middle = 0.5 * (p + q);
    const Vector2d corner(middle.x() > 0.5 * size.x() ? size.x() : 0.0,
                          middle.y() > 0.5 * size.y() ? size.y() : 0.0);
    // Edges along the rectangle leave nothing between.
    if (std::abs((p - corner).x() * (q - corner).y() - (p - corner).y() * (q - corner).x()) < 1e-12) continue;
    triangles.push_back({corner, q, p});
  }
  return triangles;
}

Vector3d OpeningShape::at(double u, double v, double depth_m) const {
  return outer.origin + u * outer.u + v * outer.v - depth_m * outer.u.cross(outer.v);
}

std::array<Vector3d, 4> OpeningShape::outer_corners() const {
  return corners_at(*this, 0.0, 0.0);
}

std::array<Vector3d, 4> OpeningShape::inner_corners() const {
  return corners_at(*this, thickness_m, splay_m);
}

std::array<Vector3d, 4> BuiltOpening::outer_corners(const OpeningShape& s) const {
  return first_four(
      on_face(*this, outer, ring_of(corners_at(s, 0.0, 0.0)), ring_of(corners_at(s, 0.05, 0.0))));
}

std::array<Vector3d, 4> BuiltOpening::inner_corners(const OpeningShape& s) const {
  const double from = s.splay_m > 0.0 ? splay_depth(s) : 0.0;
  return first_four(on_face(*this, inner, ring_of(corners_at(s, from, 0.0)), ring_of(s.inner_corners())));
}

std::vector<Vector3d> BuiltOpening::outer_outline(const OpeningShape& s) const {
  return on_face(*this, outer, ring_at(s, s.outline(), 0.0), ring_at(s, s.outline(), s.thickness_m));
}

std::vector<Vector3d> BuiltOpening::inner_outline(const OpeningShape& s) const {
  if (s.head == HeadForm::rectangular) return ring_of(inner_corners(s));
  return on_face(*this, inner, ring_at(s, s.outline(), 0.0), ring_at(s, s.outline(), s.thickness_m));
}

void add_opening_parts(Mesh& mesh, const OpeningShape& s, const BuiltOpening* built, RandomStream& random) {
  add_all_reveals(mesh, s, built);
  const MeshMark begin = mesh.mark();
  if (s.kind == OpeningKind::window) {
    s.head != HeadForm::rectangular ? add_curved_frame(mesh, s) : add_window_frame(mesh, s);
    if (s.cover == Cover::curtain) add_curtain(mesh, s, random);
    if (s.cover == Cover::blind) add_blind(mesh, s);
  } else {
    mesh.add_sheet(ring_of(corners_at(s, 0.5 * s.thickness_m, 0.0)), surface_of(Element::portal, s.id));
    add_leaf(mesh, s);
  }
  if (built != nullptr) mesh.map(begin, mesh.mark(), built->map);
}

}  // namespace limen
