// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/bim/build/bim_builder.h"

namespace limen {

/// The openings of a model as boxes, about the same origin as the shapes are. An opening is left out where it
/// passes through no standing face (stair holes in slabs), or ends inside its host (niches).
std::vector<BimOpening> opening_boxes(const RawModel& raw);

}  // namespace limen
