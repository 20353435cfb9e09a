// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/truth/truth.h"

#include <algorithm>
#include <utility>

namespace limen {

Truth of_seen_planes(Truth truth) {
  for (TruePlane& plane : truth.planes) plane.inliers.assign(truth.scans.size(), 0);
  for (std::size_t scan = 0; scan < truth.scans.size(); ++scan)
    for (const std::int32_t plane : truth.scans[scan].plane_of_point)
      if (plane >= 0) ++truth.planes[static_cast<std::size_t>(plane)].inliers[scan];
  std::vector<std::int32_t> renumbered(truth.planes.size(), -1);
  std::vector<TruePlane> seen;
  for (std::size_t i = 0; i < truth.planes.size(); ++i) {
    const auto& counts = truth.planes[i].inliers;
    if (std::none_of(counts.begin(), counts.end(), [](std::size_t n) { return n > 0; })) continue;
    renumbered[i] = static_cast<std::int32_t>(seen.size());
    seen.push_back(std::move(truth.planes[i]));
  }
  truth.planes = std::move(seen);
  for (ScanTruth& scan : truth.scans)
    for (std::int32_t& plane : scan.plane_of_point)
      if (plane >= 0) plane = renumbered[static_cast<std::size_t>(plane)];
  return truth;
}

}  // namespace limen
