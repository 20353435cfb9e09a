// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "limen/geometry/rigid.h"
#include "limen/model/look_alike_evidence.h"

namespace limen {

/// How well the surfaces of two nodes agree with a pose, scored as for a pair; m^2.
struct PoseSurface {
  double agreeing_m2 = 0.0;
  double contradicted_m2 = 0.0;  ///< is where the other saw free space
};

/// Asks two nodes of a pose that neither proposed (`target_from_source`); of those that cannot be asked
/// nothing is known. Any number of threads may ask at once.
struct PoseQuery {
  std::function<PoseSurface(int source, int target, const Rigid3& target_from_source)> surface = {};
  /// What things and walls say of a look-alike place.
  std::function<std::optional<LookAlikeEvidence>(int source, int target, const Rigid3& target_from_source)>
      things = {};

  explicit operator bool() const { return static_cast<bool>(surface); }
};

}  // namespace limen
