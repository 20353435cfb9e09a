// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/cells/cell_grid.h"

namespace limen {

/// Of the inlier threshold: how far the points of a cube may be from its plane, root mean square.
inline constexpr double kGateShare = 0.6;

/// Between the normals of two pieces of one plane.
inline constexpr double kJoinAngleDeg = 3.0;

struct RegionOptions {
  double threshold_m = 0.01;    ///< of a plane's inliers
  int min_inliers = 200;        ///< half of them make a plane of a region; less may join one
  double max_angle_deg = 12.0;  ///< between a cube's normal and its plane's
};

/// Grows planes over cubes whose points lie in a plane, one level of cubes at a time: the part of
/// grow_planes.h that makes planes.
class RegionGrower {
 public:
  RegionGrower(const MortonOrder& sorted, const RegionOptions& options);

  /// Grows planes over the points at the positions `active`, and labels these and the points around them.
  void grow_level(int level, const std::vector<std::uint32_t>& active, std::vector<std::int32_t>& labels);

  [[nodiscard]] std::size_t planes() const { return planes_.size(); }

 private:
  /// A region under construction, or a plane, about the curve's anchor.
  struct Region {
    PointMoments moments;
    Plane plane;
    std::vector<std::int32_t> cells;
  };

  void mark_planar(CellGrid& grid) const;
  [[nodiscard]] bool fits(const CellShape& shape, const Plane& plane) const;
  Region flood(CellGrid& grid, const std::vector<std::int32_t>& start, const Plane& plane, bool refit) const;
  [[nodiscard]] Plane consensus(const CellGrid& grid, const Region& region) const;
  void trim(CellGrid& grid, Region& region, const Plane& plane) const;
  void grow_region(CellGrid& grid, std::int32_t seed);
  void settle(CellGrid& grid, const Region& region);
  [[nodiscard]] std::int32_t plane_joined_by(const PointMoments& moments, const Plane& plane) const;
  void label_points(const CellGrid& grid, const std::vector<std::uint32_t>& active,
                    std::vector<std::int32_t>& labels) const;
  [[nodiscard]] std::int32_t nearest(const Vector3d& point, const std::vector<std::int32_t>& near) const;

  const MortonOrder* sorted_;
  RegionOptions options_;
  double gate_m_;
  std::vector<Region> planes_;
};

}  // namespace limen
