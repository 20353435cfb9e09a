// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/model/result.h"
#include "limen/model/segment_set.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// Registers two sets of 3-D segments from any source, for any starting pose (2023, part IV): candidates
/// (enumerate_segment_poses.h), least squares over matched segments (refine_segments.h), rank by the robust
/// distance (8), and the verdict: `registered` only where what tells the best pose from every different one
/// speaks clearly for it. Automatic gravity: z is up in both sets where most segments are vertical or level,
/// and a pose that keeps it up is not clearly worse than the others. Poses are between world coordinates.
/// Hypothesis::score is the length in common in metres, weighted and symmetrised as in (8) and (14).
///
/// Segments tell nothing of free space: two sets that show the two faces of one wall are laid on one another,
/// a wall's thickness off.
RegistrationResult register_segments(const SegmentSet& source, const SegmentSet& target,
                                     Gravity gravity = Gravity::automatic,
                                     Monitor& monitor = silent_monitor());

}  // namespace limen
