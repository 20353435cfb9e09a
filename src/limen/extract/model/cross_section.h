// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/bim_model.h"

namespace limen {

/// The area in which the closed surface made of `faces` meets the plane of `frame`, in its 2-D coordinates.
/// Gaps in the surface up to `tolerance_m` are bridged; what does not close is left out.
std::vector<Polygon> cross_section(const std::vector<const BimFace*>& faces, const PlaneFrame& frame,
                                   double tolerance_m = 0.002);

}  // namespace limen
