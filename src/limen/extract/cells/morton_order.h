// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// For lists whose values are all written by their makers, on all threads: new values are not set to 0 first.
template <typename Value>
class UnsetAllocator : public std::allocator<Value> {
 public:
  // NOLINTBEGIN(readability-identifier-naming): the names of the standard's requirements of an allocator
  template <typename Other>
  struct rebind {
    using other = UnsetAllocator<Other>;
  };
  // NOLINTEND(readability-identifier-naming)

  template <typename Other>
  void construct(Other* place) noexcept {
    ::new (static_cast<void*>(place)) Other;
  }
  template <typename Other, typename... Arguments>
  void construct(Other* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
};

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

/// A point's place along the curve.
struct CurvePlace {
  std::uint64_t code;   ///< its finest cube
  std::uint32_t index;  ///< of the point
};
using CurvePlaces = std::vector<CurvePlace, UnsetAllocator<CurvePlace>>;

/// The order alone, for those who need no copy of the points. Points of one cube stay in their order.
struct CurveOrder {
  CurvePlaces places;
  Vector3d anchor = Vector3d::Zero();  ///< corner of cell 0, 0, 0
};
CurveOrder along_curve(const std::vector<Vector3d>& points, double cell_m);

/// Cell coordinates of a code, and back (each 21 bits).
std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z);
struct CellIndex {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t z = 0;
};
CellIndex morton_decode(std::uint64_t code);

}  // namespace limen
