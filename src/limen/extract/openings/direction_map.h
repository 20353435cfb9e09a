// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// In which directions a static scanner got anything back: a raster of azimuth and elevation about the z axis
/// of the scan's frame.
class DirectionMap {
 public:
  /// Knows nothing: every direction counts as answered.
  DirectionMap() = default;
  DirectionMap(const Scan& scan, const Vector3d& centre);

  [[nodiscard]] const Vector3d& centre() const { return centre_; }
  /// Nothing came back from within `radius_rad` of the direction of `x`; false near the poles of the raster.
  [[nodiscard]] bool silent(const Vector3d& x, double radius_rad) const;

 private:
  Vector3d centre_ = Vector3d::Zero();
  std::vector<char> answered_;
};

}  // namespace limen
