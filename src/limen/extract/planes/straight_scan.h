// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/base/progress.h"
#include "limen/model/scan.h"

namespace limen {

struct StraightOptions {
  double threshold_m = 0.025;     ///< of the planes that tell the drift
  double min_width_m = 2.5;       ///< of such a plane, its narrower side
  double noise_m = 0.005;         ///< of a point about its plane, relief and all
  double points_per_look = 50.0;  ///< how many points err alike
  double knot_s = 1.0;            ///< a trajectory's error is given at knots so far apart
  int most_knots = 100;
  double change_m = 0.003;  ///< by which it changes from knot to knot, one standard deviation
  double stray_m = 0.03;    ///< and by which it strays in all
  double least_m = 0.0015;  ///< drifts below this are left alone
  std::size_t max_points = 150000;

  void check() const;
};

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
ScanDrift scan_drift(const Scan& scan, const StraightOptions& options = {},
                     Monitor& monitor = silent_monitor());

/// The scan with that taken out of its points and scanner positions.
Scan straightened(Scan scan, const ScanDrift& drift);

}  // namespace limen
