// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/register/judge/model_odds.h"
#include "limen/register/judge/model_walls.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/judge/twin_odds.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {

/// A refined pose with its final score, local frames.
struct JudgedPose {
  RefinedPose refined;
  PoseScore score;
  WallBalance walls;      ///< of a scan in a model
  double prior_m2 = 0.0;  ///< what a belief about the start speaks for it, in surface that would tell as much

  /// What poses are ranked by.
  [[nodiscard]] double value() const { return score.value() + prior_m2; }
};

struct VerdictOptions {
  double risk = 0.001;                     ///< `registered` may be wrong with this probability at most ...
  double probable_risk = 0.05;             ///< ... and `probable` with this
  TwinOptions twin;                        ///< of two rooms built alike
  double min_agreeing_m2 = 2.5;            ///< common planar surface that a pose must show
  double max_contradiction = 0.10;         ///< contradicted over agreeing surface
  double max_contradiction_in_use = 0.25;  ///< the same where things tell that a room was used in between
  double full_evidence_m2 = 10.0;  ///< with less agreeing surface, proportionally less contradiction is borne
  /// One scan looks through walls that the other stands behind: where no opening shows the two to meet, a
  /// pose shifted by a storey or a house agrees on façades and ceilings alike, and only contradiction tells.
  bool through_wall = false;
  double max_unopened_contradiction = 0.03;  ///< then, over agreeing surface ...
  double unopened_allowance_m2 = 0.2;        ///< ... and this much
  ModelOddsOptions model_odds;               ///< that a model explains a scan's walls by chance
  /// One side is a model: with more contradicted surface than this a pose is not sure.
  bool in_model = false;
  double max_model_contradiction = 0.02;     ///< over agreeing surface ...
  double model_allowance_m2 = 0.5;           ///< ... and this much
  double max_rival_contradiction = 0.25;     ///< a pose contradicted more than this is no rival
  double excess_contradiction_m2 = 1.0;      ///< nor is one contradicted more than the best by this ...
  double excess_contradiction_share = 0.02;  ///< ... and this share of its agreeing surface
  double min_rival_value = 0.65;  ///< a pose whose value is a smaller share of the best one's is no rival
  double max_rival_share =
      0.40;  ///< a pose is a rival if this share of what tells it from the best speaks for it, unless
             ///< so much more speaks for the best that it is less probable than `risk`
  double min_lead_m2 = 0.75;       ///< or if less surface than this speaks for the best against it
  double min_held_m2 = 0.03;       ///< surface (times lever^2 for turns) that must hold each freedom
  double max_sigma_m = 0.012;      ///< a shift known less well than this counts as open
  double max_sigma_deg = 0.1;      ///< and so does a turn
  double max_drifting_m = 0.05;    ///< the same with what a trajectory may be off by: beyond it a place a
  double max_drifting_deg = 0.5;   ///< wall further on, or another wall of the room, fits as well
  double same_rotation_deg = 1.0;  ///< poses nearer than both bounds are one pose
  double same_shift_m = 0.05;

  void check() const;
};

/// What the data says of a set of refined poses: outcome, reason, order of the poses.
struct Verdict {
  Outcome outcome = Outcome::no_match;
  std::string reason;
  std::vector<std::size_t> ranking;  ///< indices of distinct poses, best first
  std::vector<std::size_t> rivals;   ///< those that cannot be told from the best
  double log_odds_of_model = 0.0;    ///< in a model: of the best pose against chance, natural logarithm
  std::vector<UnobservedFreedom> unobserved;  ///< of the best pose
  /// More is contradicted than under right poses: not sure, whatever its probability is.
  bool unsure = false;
};

/// Decides: enough common surface, no contradiction, a clear lead over every different pose, six freedoms
/// held.
/// `contrast` tells two poses apart, given their indices.
using ContrastFunction = std::function<PoseContrast(std::size_t first, std::size_t second)>;
Verdict judge(const std::vector<JudgedPose>& poses, const ContrastFunction& contrast,
              const VerdictOptions& options = {});

/// Of an ambiguous verdict the likeliest pose leads: where more surface agrees under one, but what tells the
/// two apart speaks for another, the answer is that other one.
Verdict led_by_likeliest(Verdict verdict, const std::vector<JudgedPose>& poses,
                         const ContrastFunction& contrast, const VerdictOptions& options = {});

/// What a pose leaves open.
struct OpenFreedoms {
  std::vector<UnobservedFreedom> list;
  bool by_drift = false;  ///< the data hold it, but a trajectory may be off by too much
};

/// Freedoms that the matched surface does not hold, else those that it holds loosely, else those that are
/// loose once what a trajectory may be off by is counted: in `with_drift`, the pose's covariance (turns, then
/// shifts; rad, m).
OpenFreedoms open_freedoms(const RefinedPose& pose, const Matrix6d& with_drift,
                           const VerdictOptions& options = {});

/// Whether two poses differ only along shifts that the matched surface leaves open under the first.
bool is_slid(const RefinedPose& first, const RefinedPose& second, const VerdictOptions& options = {});

/// Distinct poses, best value first: indices.
std::vector<std::size_t> rank(const std::vector<JudgedPose>& poses, const VerdictOptions& options = {});

/// Freedoms of a pose that less than `min_held_m2` of matched surface holds.
std::vector<UnobservedFreedom> unobserved_freedoms(const RefinedPose& pose, double min_held_m2);

/// Freedoms that are held, but less well than the bounds ask for: by far-off or hardly seen openings, say, or
/// by a trajectory that drifts. `covariance` of a pose: turns, then shifts (rad, m). The name tells how well.
std::vector<UnobservedFreedom> loose_freedoms(const Matrix6d& covariance, double max_sigma_m,
                                              double max_sigma_deg);

}  // namespace limen
