// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/polygon.h"
#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// What hangs before or is in an opening.
enum class Cover { none, curtain, blind };
enum class OpeningKind { window, open_door, closed_door };

/// How an opening ends above.
enum class HeadForm {
  rectangular,
  segmental,   ///< a flat arch
  semicircle,  ///< as high as half the width
  round        ///< no jambs: an ellipse that touches all four sides of the rectangle
};

/// The form's name as it is in truth.json.
const char* to_string(HeadForm head);

/// A passage through a wall: its clear opening on the outer face (and, splayed, on the inner one) and what is
/// built into it. The wall's two faces are parallel, `thickness_m` apart.
struct OpeningShape {
  int id = -1;                 ///< index into Truth::openings
  PlaneFrame outer;            ///< origin: lower left corner on the outer face, seen from outside; v up
  double width_m = 1.2;        ///< clear, outside
  double height_m = 1.4;       ///< clear, outside
  double thickness_m = 0.35;   ///< of the wall
  double splay_m = 0.0;        ///< how much wider the inner opening is, left, right and above
  double frame_depth_m = 0.1;  ///< of the window frame's face behind the outer one
  double bar_m = 0.06;         ///< width of frame bars and mullions
  int mullions = 1;            ///< upright bars inside the frame
  int transoms = 0;            ///< horizontal bars
  OpeningKind kind = OpeningKind::window;
  Cover cover = Cover::none;
  double leaf_angle_rad = 1.6;  ///< of an open door's leaf
  bool hinge_left = true;
  HeadForm head = HeadForm::rectangular;  ///< of windows without splay
  double rise_m = 0.0;                    ///< of a segmental arch

  [[nodiscard]] std::array<Vector3d, 4> outer_corners() const;
  [[nodiscard]] std::array<Vector3d, 4> inner_corners() const;
  /// The clear opening on the outer face, (u, v), counter-clockwise seen from outside. Curves are drawn with
  /// straight pieces, and these are what is built; the four corners where the head is rectangular.
  [[nodiscard]] Ring outline() const;
  /// The outline in space: on the outer face, on the inner one (in the same order).
  [[nodiscard]] std::vector<Vector3d> outer_outline() const;
  [[nodiscard]] std::vector<Vector3d> inner_outline() const;
  /// The point (u, v) of the outer face, `depth_m` inwards.
  [[nodiscard]] Vector3d at(double u, double v, double depth_m) const;
};

/// An opening as it was built into a wall whose faces are not quite where they were drawn. Lines of the drawn
/// opening that run through the wall end on its faces.
struct BuiltOpening {
  AffineMap map;  ///< of all its parts
  Plane outer;    ///< the wall's faces
  Plane inner;

  [[nodiscard]] std::array<Vector3d, 4> outer_corners(const OpeningShape& shape) const;
  [[nodiscard]] std::array<Vector3d, 4> inner_corners(const OpeningShape& shape) const;
  [[nodiscard]] std::vector<Vector3d> outer_outline(const OpeningShape& shape) const;
  [[nodiscard]] std::vector<Vector3d> inner_outline(const OpeningShape& shape) const;
};

/// Triangles, counter-clockwise, between a convex outline and the rectangle [0, width] x [0, height] it
/// touches on all sides: what of the wall fills the corners of the rectangle. Empty for the rectangle itself.
std::vector<std::array<Vector2d, 3>> spandrels(const Ring& outline, const Vector2d& size);

/// Reveals, frame, mullions, glass or portal, curtain or blind, door leaf. `built`: null as drawn.
void add_opening_parts(Mesh& mesh, const OpeningShape& shape, const BuiltOpening* built,
                       RandomStream& random);

}  // namespace limen
