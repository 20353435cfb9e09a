// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/project/adjust/survey_point.h"
#include "limen/project/control/fit_points.h"

namespace limen {

/// Nodes that links hold in one frame of their own.
struct FramedNodes {
  std::vector<Rigid3> frame_from_node;
  std::vector<Matrix6d> covariance;  ///< of a turn about the node's origin and a shift; frame axes
  std::vector<bool> member;          ///< of each node: it counts
};

/// The pose of their frame in that of the known coordinates.
struct ControlDatum {
  PointFit fit;
  std::vector<std::size_t> points;  ///< of the fit's pairs: numbers of the marked points
};

/// Robust fit of all known points that members see to their coordinates (fit_points.h); what the nodes'
/// places leave open counts with each point.
ControlDatum control_datum(const std::vector<MarkedPoint>& points, const FramedNodes& nodes);

}  // namespace limen
