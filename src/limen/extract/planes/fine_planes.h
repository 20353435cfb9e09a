// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

/// Narrow strips of planes that are known: the shoulders of cars beside their bonnets, a wall between two
/// mouldings. Points without a plane join one within the box of its points where, square by square, they lie
/// much denser within the threshold than beside it, seen from the same side. The larger plane takes first.
PlaneLabels with_strips(const Scan& scan, const PlaneLabels& planes, double threshold_m);

/// Of fine_planes() and fine_station_planes() (fine_station.h).
struct FineOptions {
  double noise_m = 0.003;   ///< of a point about its plane, one standard deviation
  double drift_m = 0.0005;  ///< by which parts of one surface may stray beside the noise; stations: 0.001
  int min_inliers = 200;    ///< smallest plane, points
};

/// Planes of a mobile scan as finely as its noise allows: parts that only a gate had put together
/// are separated (join_pieces.h), and the relief of walls is found (relief_sheets.h). `planes` were found at
/// the threshold of the noise. A scan without scanner positions keeps its planes' two sides together.
PlaneLabels fine_planes(const Scan& scan, const PlaneLabels& planes, const FineOptions& options);

}  // namespace limen
