// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "limen/base/random.h"
#include "limen/simulate/mesh.h"

namespace limen {

/// What hangs before or stands in an opening.
enum class Cover { none, curtain, blind };
enum class OpeningKind { window, open_door, closed_door };

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

  [[nodiscard]] std::array<Vector3d, 4> outer_corners() const;
  [[nodiscard]] std::array<Vector3d, 4> inner_corners() const;
  /// The point (u, v) of the outer face, `depth_m` inwards.
  [[nodiscard]] Vector3d at(double u, double v, double depth_m) const;
};

/// Reveals, frame, mullions, glass or portal, curtain or blind, door leaf.
void add_opening_parts(Mesh& mesh, const OpeningShape& shape, RandomStream& random);

}  // namespace limen
