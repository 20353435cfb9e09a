// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/model/twin_evidence.h"

namespace limen {

/// What the surface of two nodes says of a pose, as a pair's pose is scored; m^2.
struct PoseHeard {
  double agreeing_m2 = 0.0;
  double contradicted_m2 = 0.0;  ///< stands where the other saw free space
  double value_m2 = 0.0;         ///< what poses are ranked by
};

/// A node, and the pose that another has in it.
struct NodePose {
  int target = -1;
  Rigid3 target_from_source;
};

/// Asks two nodes of a pose that neither proposed (`target_from_source`); of those that cannot be asked
/// nothing is heard. Any number of threads may ask at once.
struct PoseHearing {
  std::function<PoseHeard(int source, int target, const Rigid3& target_from_source)> surface = {};
  /// What things say of a twin.
  std::function<std::optional<TwinEvidence>(int source, int target, const Rigid3& target_from_source)>
      things = {};
  /// How much surface of a station mobile passes confirm beyond what `held` confirm, m^2, less what they
  /// contradict beyond it, as poses are ranked. `others`: where the station stands in all that may be asked.
  std::function<double(int source, const std::vector<NodePose>& held, const std::vector<NodePose>& others)>
      beyond = {};

  explicit operator bool() const { return static_cast<bool>(surface); }
};

}  // namespace limen
