// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "limen/geometry/rigid.h"

namespace limen {

/// What two nodes say of a pose that neither proposed, as a pair's pose is scored; m^2 of surface.
struct PoseHeard {
  double agreeing_m2 = 0.0;
  double contradicted_m2 = 0.0;  ///< stands where the other saw free space
};

/// Asks two nodes of a pose; of those that cannot be asked nothing is heard.
using PoseHearing = std::function<PoseHeard(int source, int target, const Rigid3& target_from_source)>;

}  // namespace limen
