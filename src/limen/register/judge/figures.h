// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// How high (m, upright frame) the floor is below a point; nothing where none is known there.
using FloorBelow = std::function<std::optional<double>(const Vector3d&)>;

/// What is clear of all else, as narrow and as high as a person: of each piece of matter (its middle,
/// metres, upright frame) the number of the figure that it is part of, or -1. A lamp or a coat rack may be
/// one as well.
std::vector<int> find_figures(const std::vector<Vector3d>& pieces, const FloorBelow& floor_below);

}  // namespace limen
