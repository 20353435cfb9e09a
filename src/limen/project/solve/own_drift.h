// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/state/project_node.h"

namespace limen {

/// How fast the trajectory of each pass drifts, from the surfaces that it sees more than once itself: the
/// pass is bent alone (BentPasses), and the rate of the random walk that makes this most probable says how
/// far the pass strays from a rigid body over its whole length. Nothing of the other scans enters, so that no
/// wrong link can teach a wrong rate. Fills `drift` of the passes with a way; others keep what the relief of
/// their planes shows (Features::drift_m), which for large drifts is too little: planes are torn by then.
void learn_own_drift(std::vector<ProjectNode>& nodes);

}  // namespace limen
