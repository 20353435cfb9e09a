// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/model/result.h"
#include "limen/report/html/html_scene.h"

namespace limen {

/// The plane of every point as one byte: 1 + index into Features::planes, 0: on none of the first 255.
std::vector<std::uint8_t> plane_of_points(const SceneSide& side);

/// Distance of every point of the source, under the best pose, to the target's plane that its own plane was
/// matched with.
struct PointResiduals {
  double range_m = 0.01;  ///< what the largest byte represents; distances beyond count as it
  /// 128 + 127 * distance / range, positive before the plane; 0: not matched.
  std::vector<std::uint8_t> values;
};
PointResiduals point_residuals(const ReportScene& scene, const RegistrationResult& result,
                               const std::vector<std::uint8_t>& plane_of_source);

}  // namespace limen
