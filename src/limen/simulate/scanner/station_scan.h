// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "limen/base/random.h"
#include "limen/model/scan.h"
#include "limen/simulate/buildings/mesh.h"
#include "limen/simulate/scanner/drift.h"
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

// What scans of made-up buildings and scans of models have in common.

/// A rotation about the vertical by any angle.
Matrix3d any_heading(RandomStream& random);

/// The orientation of a station's frame: uniform over all, or level with any heading.
Matrix3d station_rotation(bool any_rotation, RandomStream& random);

/// The nearest multiple of 2^-16 m, so that adding a whole number of metres is exact.
Vector3d rounded(const Vector3d& x);

/// `fire` of a `pattern` with as many pulses as give about `points` echoes: a thin sweep measures the share
/// that comes back.
Sweep sweep_of_points(std::size_t points, const std::function<ScanPattern(std::size_t pulses)>& pattern,
                      const std::function<Sweep(const ScanPattern&)>& fire);

/// The echoes as a station keeps them: in its own frame, about its scanner position.
Scan station_scan(std::string name, const Sweep& sweep, const Rigid3& scan_from_scene);

/// The echoes of a `pattern` as a moving scanner keeps them, where its trajectory says that they are.
Scan pass_scan(std::string name, const Sweep& sweep, const ScanPattern& pattern, const Drift& drift,
               const Rigid3& scan_from_scene);

}  // namespace limen
