// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/graph/pose_graph.h"
#include "limen/project/graph/shared_views.h"

namespace limen {

/// Of a place that is a thousand times as probable as another there is no question.
inline constexpr double kRivalClearNats = 6.9;

/// Places nearer than both are one.
inline constexpr double kSamePlaceM = 0.05;
inline constexpr double kSamePlaceRad = 0.0175;

/// Every pose that was not accepted would move one of its ends, and with it all that hangs together with that
/// end: the smallest cut of the accepted links that the movement breaks (those that can follow it by another
/// of their poses cost nothing) divides the component; tried are the cut next to either end, and the one
/// between what is linked to one end and the other; for the ends of all links that speak for the movement,
/// by the number of links that a cut breaks, and for those of the one link, by what these say once twins are
/// granted; and either end alone. Links on the cut speak for the present place, the other place, or both;
/// those that see the same surface count once. Listed are the movements for which the present place is not a
/// thousand times as probable, by what the links say of their poses and how probably all that speak for one
/// place lie on a twin.
std::vector<GraphQuestion> rival_places(const PoseGraph& graph, const AcceptedPoses& accepted);

}  // namespace limen
