// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

struct StripOptions {
  double threshold_m = 0.008;  ///< farthest a point may lie from its plane
  double aside_m = 0.5;        ///< how far beyond a plane's points its strips are looked for

  void check() const;
};

/// Narrow strips of planes that are known: the shoulders of cars beside their bonnets, a wall between two
/// mouldings. Points without a plane join one within the box of its points where, square by square, they lie
/// much denser within the threshold than beside it, seen from the same side. The larger plane takes first.
PlaneLabels with_strips(const Scan& scan, const PlaneLabels& planes, const StripOptions& options);

}  // namespace limen
