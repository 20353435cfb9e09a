// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "limen/geometry/morton_curve.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// Points in the order of a Morton curve over cubes: every cube of every level (a power of two of the finest)
/// is one contiguous run. Stable, so the order does not depend on the thread count.
struct MortonOrder {
  std::shared_ptr<const std::vector<Vector3d>> points;  ///< along the curve; not owned where they lay so
  std::vector<std::uint32_t> indices;  ///< of the points as they were given; empty: they lay so
  std::vector<std::uint64_t> codes;    ///< codes[k]: its finest cube
  Vector3d anchor = Vector3d::Zero();  ///< corner of cell 0, 0, 0
  double cell_m = 0.02;                ///< edge of the finest cube

  [[nodiscard]] std::size_t size() const { return codes.size(); }
  [[nodiscard]] std::size_t index(std::size_t k) const { return indices.empty() ? k : indices[k]; }
  /// The k-th point along the curve, about `anchor`, metres.
  [[nodiscard]] Vector3d point(std::size_t k) const { return (*points)[k] - anchor; }
};

/// Sorts `points`, which must outlive the order, along the curve. Cubes outside 2^21 cells per axis are
/// clamped to the border.
MortonOrder morton_order(const std::vector<Vector3d>& points, double cell_m);

/// The order alone, for those who need no copy of the points. Points of one cube stay in their order.
struct CurveOrder {
  CurvePlaces places;
  Vector3d anchor = Vector3d::Zero();  ///< corner of cell 0, 0, 0
};
CurveOrder along_curve(const std::vector<Vector3d>& points, double cell_m);

}  // namespace limen
