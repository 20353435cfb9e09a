// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/geometry/rigid.h"

namespace limen {

/// A pose proposed by matching planes, in the scans' local frames.
struct PoseCandidate {
  Rigid3 target_from_source;
  double support_m2 = 0.0;    ///< overlap of the planes that agree, from their bounding rectangles
  int free_translations = 0;  ///< shifts that no pair of planes fixed (0 to 3)
};

}  // namespace limen
