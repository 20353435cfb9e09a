// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// An exact sphere; a radius of 0: none.
struct Ball {
  Vector3d centre = Vector3d::Zero();
  double radius_m = 0.0;
};

/// One face of the simulated world: all its triangles lie in `plane` (unless it is not planar) and are seen
/// from the normal's side.
struct Surface {
  Plane plane;
  Element element = Element::wall;
  int opening = -1;           ///< the opening it is a part of
  int back = -1;              ///< for a thin sheet: the surface seen from the other side
  bool planar = true;         ///< false: a leaf, a trunk, a curtain's fold: each triangle has its own plane
  double reflectivity = 0.6;  ///< share of light sent back
  double area_m2 = 0.0;
  Bulge bulge = {};  ///< of a wall as built: rays end on it, though the triangles lie in the plane
  Ball ball = {};    ///< which the triangles lie round: rays end on it, or pass
};

/// A rectangle in the coordinates of a panel, metres.
struct PanelRect {
  double u0 = 0.0;
  double v0 = 0.0;
  double u1 = 0.0;
  double v1 = 0.0;
};

/// x -> linear * x + shift: a place as drawn -> the place as built.
struct AffineMap {
  Matrix3d linear = Matrix3d::Identity();
  Vector3d shift = Vector3d::Zero();

  [[nodiscard]] Vector3d operator()(const Vector3d& x) const { return linear * x + shift; }
};

/// How much a mesh held at some time.
struct MeshMark {
  std::size_t surfaces = 0;
  std::size_t triangles = 0;
};

/// Where and how a box is: its corner frame's origin in the middle of the bottom face.
struct BoxPlace {
  Vector3d base = Vector3d::Zero();  ///< middle of the bottom face
  double yaw_rad = 0.0;
};

/// The simulated world: triangles in double precision, each knowing its surface. Frame: z up, metres.
class Mesh {
 public:
  int add_surface(const Surface& surface);
  void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, int surface);

  /// A convex ring, counter-clockwise seen from its visible side. Returns the surface.
  int add_polygon(const std::vector<Vector3d>& ring, const Surface& like);
  /// A thin sheet seen from both sides.
  int add_sheet(const std::vector<Vector3d>& ring, const Surface& like);
  /// The rectangle [0, width] x [0, height] of `frame` (normal u x v) less its holes. Returns the surface.
  int add_panel(const PlaneFrame& frame, const Vector2d& size, const std::vector<PanelRect>& holes,
                const Surface& like);
  /// A flat panel with corners counter-clockwise as seen from the side of `plane`'s normal, less convex holes
  /// that lie in the plane. Returns the surface.
  int add_quad_panel(const std::array<Vector3d, 4>& corners, const Plane& plane,
                     const std::vector<std::vector<Vector3d>>& holes, const Surface& like);
  /// A closed box of `size` = along x, along y, up, in the frame of `place`.
  void add_box(const BoxPlace& place, const Vector3d& size, const Surface& like);
  /// A straight prism over a horizontal convex ring (counter-clockwise from above), with a top.
  void add_prism(const std::vector<Vector3d>& ring, double height, const Surface& like);
  /// An exact sphere.
  void add_ball(const Ball& ball, Surface like);
  /// Copies triangles [begin, end), those of surfaces from `first_surface` on, moved by `shift`. No sheets.
  void add_shifted(std::size_t first_surface, const std::array<std::size_t, 2>& range, const Vector3d& shift);

  [[nodiscard]] MeshMark mark() const { return {surfaces_.size(), triangles_.size()}; }
  /// Moves what was added from `begin` on and before `end`: whole surfaces. The map must keep left and right.
  void map(const MeshMark& begin, const MeshMark& end, const AffineMap& as_built);

  [[nodiscard]] const std::vector<Vector3d>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<int>& surface_of_triangle() const { return surface_of_triangle_; }
  [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }

 private:
  std::vector<Vector3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<int> surface_of_triangle_;
  std::vector<Surface> surfaces_;
};

/// Surfaces grouped into planes: coplanar faces looking the same way share one.
struct MergedPlanes {
  std::vector<int> plane_of_surface;  ///< -1 for surfaces that are not planar
  std::vector<TruePlane> planes;      ///< in the mesh's frame, no inliers yet
};

/// Merges planes within `distance_m` (of their offsets about the mesh's origin) and 0.01 degrees a millimetre
/// of it; the largest face lends its plane.
MergedPlanes merge_planes(const Mesh& mesh, double distance_m = 1e-3);

/// The surface of a kind of material, with its usual reflectivity.
Surface surface_of(Element element, int opening = -1);

}  // namespace limen
