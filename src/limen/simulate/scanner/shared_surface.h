// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/simulate/buildings/mesh.h"
#include "limen/simulate/scanner/scanner.h"

namespace limen {

/// Counts which surface scans have in common, in cells of 0.2 m on the true planes: a cell with a point of
/// either scan is seen by both. What lies in no plane (leaves, poles) is not counted. Memory: 12 bytes a
/// cell.
class SharedSurfaceCounter {
 public:
  explicit SharedSurfaceCounter(const MergedPlanes& planes) : planes_(planes) {}

  /// Scans in their order. Returns the surface that this one saw, m^2.
  double add(const Sweep& sweep);
  /// Of all pairs of scans that were added, sorted.
  [[nodiscard]] std::vector<SharedSurface> shared() const;

 private:
  const MergedPlanes& planes_;
  std::vector<std::vector<std::uint64_t>> cells_;  ///< sorted, per scan
};

}  // namespace limen
