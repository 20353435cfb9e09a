// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/geometry/rigid.h"

namespace limen {

/// A pose proposed by matching features, in the scans' local frames.
struct PoseCandidate {
  Rigid3 target_from_source;
  /// By what its proposer puts it before others of the same list, higher first. No measure: poses of
  /// different proposers are not compared by it, they are scored.
  double precedence = 0.0;
};

}  // namespace limen
