// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/register/judge/model_walls.h"
#include "limen/register/judge/share_belief.h"

namespace limen {

struct ModelOddsOptions {
  /// Share of the walls that are the model's where the pose is right: the rest was moved, is missing, or is
  /// furniture as high as the room. Of 24 furnished and 24 unfurnished simulated rooms: 0.64 to 1.
  ShareBelief of_model{0.86, 8.0};
  /// Share that the best of all wrong poses explains by chance, before any is seen. Of 40 scans in models of
  /// other buildings: 0 to 0.5.
  ShareBelief by_chance{0.35, 12.0};
  double known_poses = 4.0;  ///< what is presumed of chance counts as much as so many poses

  void check() const;
};

/// Of each pose the logarithm of the odds that the model explains the walls because they are the model's, not
/// by chance. Share q of the walls is the model's under a right pose, c under a wrong one; both are known as
/// beta distributions only and integrated out (beta-binomial). What chance reaches here, the other poses
/// show: they are the best of all wrong ones. A pose counts among them as far as it is probably none of the
/// right ones, for rooms repeat.
std::vector<double> log_odds_of_model(const std::vector<WallBalance>& poses,
                                      const ModelOddsOptions& options = {});

}  // namespace limen
