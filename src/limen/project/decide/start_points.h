// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "limen/register/options/pair_options.h"

namespace limen {

/// A point that a user shows in two scans: x, y, z in the source's coordinates and in the target's, metres.
using ShownPoint = std::array<double, 6>;

/// "1.2,3.4,0.5=10.2,-7.1,0.5": the point in the source, and in the target. Throws Error.
ShownPoint shown_point(const std::string& text);
std::string words_of(const ShownPoint& point);

/// The pose that three or more such points give, for scans that stand upright where the points bear that,
/// else by all six freedoms; no surer than somebody clicks. Throws Error where there are fewer, two are one
/// place, they lie nearly in a line, or no pose brings them together.
StartPrior start_from_points(const std::vector<ShownPoint>& points);

}  // namespace limen
