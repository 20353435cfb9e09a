// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/extract/targets/found_target.h"
#include "limen/model/scan.h"

namespace limen {

/// Spheres and boards of two dark and two bright quadrants in a static scan whose centre is known, in the
/// order of their places; none in any other scan. Boards need intensities or colours. What may be something
/// else is left out: another radius, a pattern that goes on beyond the board's size, too few points.
std::vector<FoundTarget> find_targets(const Scan& scan, const TargetOptions& options);

}  // namespace limen
