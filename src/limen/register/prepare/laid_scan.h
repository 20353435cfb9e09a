// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/scan.h"
#include "limen/register/frame/scan_frame.h"
#include "limen/register/prepare/kept_points.h"

namespace limen {

/// What is kept of a scan that is laid in its frame.
struct LayOptions {
  KeepOptions keep = kKeepAll;
  bool lines = true;  ///< with the scan lines, where they are known
  bool times = true;  ///< of a mobile scan
};

/// The scan in its frame, about local origin + corner, seen from the place found; its points sorted along a
/// curve through space, so that nothing that follows depends on their order in the file. Of more points than
/// are wanted a part is kept (kept_points.h). Times of a static scan, intensities and colours are left out.
Scan laid_in(const Scan& scan, const ScanFrame& frame, const LayOptions& options = {});
/// The same of a scan that is not needed any more: its memory is given back on the way.
Scan laid_in(Scan&& scan, const ScanFrame& frame, const LayOptions& options = {});

}  // namespace limen
