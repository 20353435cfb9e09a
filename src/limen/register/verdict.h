// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/result.h"
#include "limen/register/refine_pose.h"
#include "limen/register/score_pose.h"

namespace limen {

/// A refined pose with its final score, local frames.
struct JudgedPose {
  RefinedPose refined;
  PoseScore score;
};

struct VerdictOptions {
  double min_agreeing_m2 = 2.5;     ///< common planar surface that a pose must show
  double max_contradiction = 0.10;  ///< contradicted over agreeing surface
  double full_evidence_m2 = 10.0;  ///< with less agreeing surface, proportionally less contradiction is borne
  double max_rival_contradiction = 0.25;  ///< a pose contradicted more than this is no rival
  double max_rival_share = 0.80;          ///< a different pose with more of the best value is a rival
  double min_lead_m2 = 1.0;               ///< the best pose must lead every different one by this
  double min_held_m2 = 0.03;              ///< surface (times lever^2 for turns) that must hold each freedom
  double same_rotation_deg = 1.0;         ///< poses nearer than both bounds are one pose
  double same_shift_m = 0.05;

  void check() const;
};

/// What the data says of a set of refined poses: outcome, reason, order of the poses.
struct Verdict {
  Outcome outcome = Outcome::no_match;
  std::string reason;
  std::vector<std::size_t> ranking;           ///< indices of distinct poses, best first
  std::vector<UnobservedFreedom> unobserved;  ///< of the best pose
};

/// Decides: enough common surface, no contradiction, a clear lead over every different pose, six freedoms
/// held.
Verdict judge(const std::vector<JudgedPose>& poses, const VerdictOptions& options = {});

/// Freedoms of a pose that less than `min_held_m2` of matched surface holds.
std::vector<UnobservedFreedom> unobserved_freedoms(const RefinedPose& pose, double min_held_m2);

}  // namespace limen
