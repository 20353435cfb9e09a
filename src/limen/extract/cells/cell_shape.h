// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "limen/extract/cells/morton_order.h"
#include "limen/geometry/plane.h"

namespace limen {

/// The plane that the points of one cube make.
struct CellShape {
  double thickness_m = 0.0;  ///< root mean square distance to its own plane
  double spread_m = 0.0;     ///< standard deviation along its second axis
  /// Largest distance to the plane of the mean of a small cube within, of a quarter of the edge, less what
  /// noise explains: high where the cube holds a step or a bend that its thickness hides.
  double unevenness_m = 0.0;
  Vector3d mean = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  PointMoments moments;

  [[nodiscard]] Plane plane() const { return {normal, normal.dot(mean)}; }
};

/// A cube with fewer points has no shape.
constexpr std::uint32_t kLeastOfShape = 6;

/// The shape of `points`, at least kLeastOfShape positions along `sorted`'s curve, all of one cube of
/// `level`.
CellShape shape_of(const MortonOrder& sorted, std::span<const std::uint32_t> points, int level);

/// Calls use(begin, end) for each run of the places in `active` whose points lie in one cube of `level`.
template <typename Use>
void for_each_cell(const MortonOrder& sorted, std::span<const std::uint32_t> active, int level,
                   const Use& use) {
  const int shift = 3 * level;
  for (std::uint32_t begin = 0; begin < active.size();) {
    const std::uint64_t cube = sorted.codes[active[begin]] >> shift;
    std::uint32_t end = begin + 1;
    while (end < active.size() && sorted.codes[active[end]] >> shift == cube) ++end;
    use(begin, end);
    begin = end;
  }
}

}  // namespace limen
