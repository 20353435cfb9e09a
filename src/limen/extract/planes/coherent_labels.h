// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/planes/settle_planes.h"

namespace limen {

struct CoherentOptions {
  double threshold_m = 0.01;    ///< farthest a point may lie from its plane
  double noise_m = 0.003;       ///< of a point about its plane, one standard deviation
  double around = 0.1;          ///< what a point of a cube around counts beside one of the own cube
  double max_angle_deg = 20.0;  ///< between a plane and the surface at a point
  int rounds = 1;

  void check() const;
};

/// Every point goes to the plane that is likeliest to have been met there: by its distance, in noises, and by
/// how many points around chose it before. With distances alone a quarter of the points between a mullion and
/// its frame, 4 mm apart at 3 mm noise, would take the wrong one. In rounds; `sums`, of the planes' points
/// about the curve's anchor, follows. A plane's label is its place in `sums`; a point that no plane explains
/// has -1.
void coherent_labels(const SettleScene& scene, const CoherentOptions& options,
                     std::vector<std::int32_t>& labels, std::vector<PointMoments>& sums);

}  // namespace limen
