// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "limen/base/random.h"
#include "limen/model/scan.h"
#include "limen/simulate/scanner/scanner.h"

// What scans of made-up buildings and scans of models have in common.

namespace limen {

/// A rotation about the vertical by any angle.
Matrix3d any_heading(RandomStream& random);

/// The orientation of a station's frame: uniform over all, or level with any heading.
Matrix3d station_rotation(bool any_rotation, RandomStream& random);

/// The nearest multiple of 2^-16 m, so that adding a whole number of metres is exact.
Vector3d rounded(const Vector3d& x);

/// `fire` of a `pattern` with as many pulses as give about `points` echoes: a thin sweep measures the share
/// that comes back.
Sweep sweep_of_points(std::size_t points, const std::function<ScanPattern(std::size_t pulses)>& pattern,
                      const std::function<Sweep(const ScanPattern&)>& fire);

/// The echoes as a station keeps them: in its own frame, about its optical centre.
Scan station_scan(std::string name, const Sweep& sweep, const Rigid3& scan_from_scene);

}  // namespace limen
