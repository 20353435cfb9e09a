// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/segment.h"

namespace limen {

/// Segments about a local origin: x_in_world = local_origin + x, metres.
struct SegmentSet {
  Vector3d local_origin = Vector3d::Zero();
  std::vector<Segment> segments;
};

}  // namespace limen
