// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/register/judge/model_walls.h"

namespace limen {

/// Of each pose the logarithm of the odds that the model explains the walls because they are the model's, not
/// by chance. Share q of the walls is the model's under a right pose, c under a wrong one; both are known as
/// beta distributions only and integrated out (beta-binomial). What chance reaches here, the other poses
/// show: they are the best of all wrong ones. A pose counts among them as far as it is probably none of the
/// right ones, for rooms repeat.
std::vector<double> log_odds_of_model(const std::vector<WallBalance>& poses);

}  // namespace limen
