// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/match/segments/enumerate_segment_poses.h"
#include "limen/model/result.h"
#include "limen/model/segment_set.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/refine/refine_segments.h"

namespace limen {

struct SegmentRegisterOptions {
  /// automatic: z is up in both sets where most segments are vertical or level, and a pose that keeps it up
  /// is not clearly worse than the others.
  Gravity gravity = Gravity::automatic;
  SegmentPoseOptions enumerate;  ///< `gravity_known` is set from `gravity`
  RefineSegmentsOptions refine;
  int refined_poses = 300;         ///< candidates that are refined and judged
  int alternatives = 200;          ///< different poses reported besides the best
  double min_common_m = 4.0;       ///< length in common that a pose must show, long segments cut short
  int min_segments = 6;            ///< segments in common
  double min_share = 0.3;          ///< where rivals explain as much, less than this is chance: no match
  double min_rival_value = 0.5;    ///< a pose with a smaller share of the best one's evidence is no rival
  double max_rival_share = 0.45;   ///< nor one for which less of what distinguishes the two supports it ...
  double min_lead_m = 2.0;         ///< ... where at least this much more supports the best
  double min_held_m = 0.3;         ///< length (times lever^2 for turns) that must hold each freedom
  double max_sigma_m = 0.02;       ///< a shift known less well than this counts as open
  double max_sigma_deg = 0.2;      ///< and so does a turn
  double same_rotation_deg = 1.0;  ///< poses nearer than both bounds are one pose
  double same_shift_m = 0.06;

  void check() const;
};

/// Registers two sets of 3-D segments from any source, for any starting pose (2023, part IV): candidates
/// (enumerate_segment_poses.h), least squares over matched segments (refine_segments.h), rank by the robust
/// distance (8), and the verdict: `registered` only where what tells the best pose from every different one
/// speaks clearly for it. Poses are between world coordinates. Hypothesis::score is the length in common in
/// metres, weighted and symmetrised as in (8) and (14).
///
/// Segments tell nothing of free space: two sets that show the two faces of one wall are laid on one another,
/// a wall's thickness off.
RegistrationResult register_segments(const SegmentSet& source, const SegmentSet& target,
                                     const SegmentRegisterOptions& options = {},
                                     Monitor& monitor = silent_monitor());

}  // namespace limen
