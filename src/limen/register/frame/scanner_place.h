// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/model/scan.h"
#include "limen/register/frame/frame_planes.h"

namespace limen {

/// As many points of a large static scan as its scanner's place needs; none of a scan that is not large: it
/// serves itself.
std::optional<Scan> sample_for_place(const Scan& scan);

/// Where the scanner of `scan` stood, about its local origin: what is claimed is tested and kept, or replaced
/// by what the data show, or unknown. `planes`: its large planes.
///
/// The density of the points on planes (sight/estimate_centre.h) confirms a place, or shows another one.
/// Where it shows none, the spread of the points over directions (sight/angular_spread.h) may still refute a
/// claim.
ScannerPlace find_scanner_place(const Scan& scan, const std::vector<FramePlane>& planes,
                                const Matrix3d& axes);

/// A place that was estimated, estimated again with better planes; any other place as it is.
ScannerPlace refined_place(const ScannerPlace& place, const Scan& scan, const std::vector<FramePlane>& planes,
                           const Matrix3d& axes);

}  // namespace limen
