// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace limen {

/// Cell coordinates of a code, and back (each 21 bits).
std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z);
struct CellIndex {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t z = 0;
};
CellIndex morton_decode(std::uint64_t code);

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

/// A point's place along the curve.
struct CurvePlace {
  std::uint64_t code;   ///< its finest cube
  std::uint32_t index;  ///< of the point
};
using CurvePlaces = std::vector<CurvePlace, UnsetAllocator<CurvePlace>>;

/// Sorts by the code, on all threads; equal codes keep their order. At most 2^32 - 1 places.
void sort_along_curve(CurvePlaces& places);

}  // namespace limen
