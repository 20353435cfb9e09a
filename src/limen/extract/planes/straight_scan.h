// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/progress.h"
#include "limen/model/scan.h"

namespace limen {

/// A trajectory's slow error, given at knots.
struct ScanDrift {
  double begin_s = 0.0;
  double step_s = 1.0;
  std::vector<Vector3d> knots;  ///< empty: no drift that matters, or no times to tell it by

  [[nodiscard]] Vector3d at(double time_s) const;
};

/// By how much a mobile scan's trajectory strays, as far as its own large planes (ground, façades) show: what
/// they bend with time. Shifts only, and none along which no plane holds it. What a wall that is passed once
/// hides - a drift that turns it - stays hidden, and harms no plane.
ScanDrift scan_drift(const Scan& scan, Monitor& monitor = silent_monitor());

/// The scan with that taken out of its points and scanner positions.
Scan straightened(Scan scan, const ScanDrift& drift);

}  // namespace limen
