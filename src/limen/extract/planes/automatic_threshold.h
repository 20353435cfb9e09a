// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/extract/planes/threshold.h"
#include "limen/model/scan.h"

namespace limen {

struct AutomaticThresholdOptions {
  std::size_t max_points = 40000;  ///< the choice is made on an even subset of about this many
  /// Thresholds tried, as multiples of the one that the noise within small cubes asks for.
  std::vector<double> factors = {1.0, 1.6, 2.5, 4.0};
  double max_threshold_m = 0.04;

  void check() const;
};

/// The inlier threshold in metres for growing planes in `scan`, chosen a contrario (2021, 3.1.1) among
/// multiples of what the noise asks for: walls that are not flat, and clouds joined from many sweeps, need
/// more than their noise over a few decimetres tells.
double automatic_threshold(const Scan& scan, const GrowOptions& grow,
                           const AutomaticThresholdOptions& options = {},
                           Monitor& monitor = silent_monitor());

/// The threshold chosen a contrario among `choice.thresholds_m`, whatever the noise (2021, 3.1.1), on an even
/// subset of about 40 000 points. `choice.min_inliers` is taken from `grow`.
double a_contrario_threshold(const Scan& scan, const GrowOptions& grow, const ThresholdOptions& choice = {},
                             Monitor& monitor = silent_monitor());

}  // namespace limen
