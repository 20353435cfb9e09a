// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/geometry/polygon.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {

/// A point of a plane in the plane's coordinates, and its index in the scan.
struct FlatPoint {
  Vector2d at = Vector2d::Zero();
  std::uint32_t point = 0;
};

/// A straight strip of a plane: from `origin` along the unit vector `along`, `inward` to its left.
struct Strip {
  Vector2d origin = Vector2d::Zero();
  Vector2d along = Vector2d::UnitX();
  double begin_m = 0.0;  ///< along
  double end_m = 0.0;
  double low_m = 0.0;  ///< inward
  double high_m = 0.0;

  [[nodiscard]] Vector2d inward() const { return {-along.y(), along.x()}; }
  [[nodiscard]] Vector2d at(double t, double h) const { return origin + t * along + h * inward(); }
};

/// The points of one plane as an image: every point fills a disc as wide as the points are apart around it,
/// so that what is filled has no gaps but those that the scanner left.
class PlaneImage {
 public:
  /// `points[indices[k]]` are the plane's points, `area_m2` about what they cover.
  PlaneImage(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& indices,
             const PlaneFrame& frame, double area_m2);

  [[nodiscard]] const PlaneFrame& frame() const { return frame_; }
  [[nodiscard]] const Box2& box() const { return box_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }
  /// Distance between neighbouring points about a place, metres; where they lie in rows, between the rows.
  [[nodiscard]] double spacing_m(const Vector2d& p) const;
  /// Radius of the discs about a place, metres.
  [[nodiscard]] double reach_m(const Vector2d& p) const;
  /// In the disc of a point.
  [[nodiscard]] bool covered(const Vector2d& p) const;
  /// The outlines of what is filled, the filled side to the left, a point for each pixel edge: outer rings
  /// run counter-clockwise, holes clockwise.
  [[nodiscard]] std::vector<Ring> contours() const;
  /// The points in a strip, in a fixed order.
  [[nodiscard]] std::vector<FlatPoint> points_in(const Strip& strip) const;

 private:
  void sort_points(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& indices,
                   double spacing_m);
  void measure_spacing(double fallback_m);
  [[nodiscard]] double elongation(std::size_t tile) const;
  void fill();
  [[nodiscard]] double finest_pixel_m() const;
  void stamp(const Vector2d& p, double radius_m);
  [[nodiscard]] std::size_t tile(const Vector2d& p) const;
  [[nodiscard]] bool filled(long column, long row) const;
  [[nodiscard]] Ring trace(long column, long row, std::vector<char>& seen) const;

  PlaneFrame frame_;
  Box2 box_;
  double tile_m_ = 0.1;
  long tile_columns_ = 1;
  long tile_rows_ = 1;
  std::vector<std::uint32_t> begins_;  ///< of each tile in flat_, and the size
  std::vector<FlatPoint> flat_;
  std::vector<float> spacing_m_;  ///< by tile
  double pixel_m_ = 0.01;
  Vector2d image_low_ = Vector2d::Zero();
  long columns_ = 0;
  long rows_ = 0;
  std::vector<char> pixels_;  ///< with an empty rim
};

}  // namespace limen
