// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/scan.h"

namespace limen {

struct StepOptions {
  double drift_m = 0.001;  ///< by which parts of one surface may stray beside the noise
  double step_m = 0.0015;  ///< mean step where two parts touch, up to which they are one bulging surface
};

/// A plane's points in parts, each of one surface as far as the noise allows: two neighbours 4 mm apart in
/// depth
/// - a mullion and its frame, the sides and the boards of a shelf - lie within one threshold, but the means
/// of cells of a dozen points show the step.
/// 1. Cells that touch become one part, the most alike first, as long as the common plane adds no more to the
///    squares of their residuals than noise (three freedoms, chi squared; the noise is that within the cells)
///    and drift explain.
/// 2. Large parts that touch and show no step where they do are one surface that bulges.
/// 3. Parts that do not touch - far from the scanner each point is one - are held to the first rule; one that
///    bulges may stray by as much.
/// Indices of the scan's points, in their order. A point of no part is in none.
std::vector<std::vector<std::uint32_t>> split_at_steps(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       const StepOptions& options);

}  // namespace limen
