// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/geometry/rigid.h"

namespace limen {

/// One number for a cell of a grid in space: whole coordinates within +-1 000 000, 21 bits of each.
inline std::int64_t cell_key(const Vector3d& whole) {
  const auto part = [](double c) { return static_cast<std::int64_t>(c) & 0x1fffff; };
  return (part(whole.x()) << 42) | (part(whole.y()) << 21) | part(whole.z());
}

/// The cell, `cell_m` wide, that holds `x`.
inline Vector3d cell_of(const Vector3d& x, double cell_m) {
  return (x / cell_m).array().floor();
}

/// The way to the k-th of the 27 cells around a cell; 13 is the cell itself.
inline Vector3d way_to_cell(int k) {
  const int x = k % 3 - 1;
  const int y = k / 3 % 3 - 1;
  const int z = k / 9 - 1;
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

}  // namespace limen
