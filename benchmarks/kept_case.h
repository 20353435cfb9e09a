// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "limen/register/frame/scan_frame.h"
#include "limen/register/prepare/kept_points.h"
#include "limen/simulate/scene.h"

namespace limen {

/// Leaves of each scan, and of what is true of its points, what features are found on.
inline void keep_as_features_do(SimulatedCase& simulated, const KeepOptions& options) {
  for (std::size_t s = 0; s < simulated.scans.size(); ++s) {
    Scan& scan = simulated.scans[s];
    const auto kept = kept_points(scan, find_scan_frame(scan, Gravity::automatic), options);
    if (!kept) continue;
    std::vector<std::int32_t>& planes = simulated.truth.scans[s].plane_of_point;
    std::vector<std::int32_t> planes_kept;
    for (const std::uint32_t i : *kept) planes_kept.push_back(planes[i]);
    planes = std::move(planes_kept);
    scan = subset(scan, *kept);
  }
}

}  // namespace limen
