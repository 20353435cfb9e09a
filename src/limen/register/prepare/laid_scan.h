// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "limen/model/scan.h"
#include "limen/register/prepare/scan_frame.h"

namespace limen {

/// The scan in its frame, about local origin + corner, seen from the place found; its points sorted along a
/// curve through space, so that nothing that follows depends on their order in the file. Times of a
/// static scan, intensities and colours are left out.
///
/// Of more than `most` points (0: all are kept) so many of each cube are kept that about `most` are left, the
/// cubes as small as that allows: what lies near the scanner is measured many times over, what lies far off
/// stays as it is.
///
/// `lines`: with the scan lines, where they are known.
Scan laid_in(const Scan& scan, const ScanFrame& frame, std::size_t most = 0, bool lines = true);

}  // namespace limen
