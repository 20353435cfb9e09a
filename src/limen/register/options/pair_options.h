// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "limen/geometry/rigid.h"

namespace limen {

/// What a user believes of a pose beforehand: both scans on one grid, a satellite fix, a compass. It is
/// evidence like any other, and may be wrong: it moves the odds between poses, and never makes one.
struct StartPrior {
  Rigid3 target_from_source;   ///< where `at` and the turn are meant; any pair of frames
  double sigma_m = 2.0;        ///< of the place, per axis, one standard deviation
  double sigma_rad = 0.08727;  ///< of the turn, per axis: 5 degrees
  double trust = 0.95;         ///< share of such beliefs that mean what they say

  void check() const;
};

/// Of the least-squares adjustment of a pose (refine/).
struct RefineOptions {
  double first_gate_m = 0.12;  ///< surfaces nearer than this are matched in the first round
  double last_gate_m = 0.015;  ///< and in the last
  int rounds = 12;
  std::size_t samples = 0;             ///< of each scan that are used, about; 0: all
  double first_opening_gate_m = 0.25;  ///< openings nearer than this within their wall are matched at first
  double last_opening_gate_m = 0.06;   ///< and in the last round
  double wall_thickness_m = 0.0;       ///< of the outer walls, as the user knows it; 0: not known
  bool planes = true;                  ///< tiles of surface are matched
  bool openings = true;                ///< openings are matched

  void check() const;
};

/// Of what is said of a pose (judge/).
struct VerdictOptions {
  double risk = 0.001;             ///< `registered` may be wrong with this probability at most ...
  double probable_risk = 0.05;     ///< ... and `probable` with this
  double min_held_m2 = 0.03;       ///< surface (times lever^2 for turns) that must hold each freedom
  double max_sigma_m = 0.012;      ///< a shift known less well than this counts as open
  double max_sigma_deg = 0.1;      ///< and so does a turn
  double max_drifting_m = 0.05;    ///< the same with what a trajectory may be off by: beyond it a place a
  double max_drifting_deg = 0.5;   ///< wall further on, or another wall of the room, fits as well
  double same_rotation_deg = 1.0;  ///< poses nearer than both bounds are one pose
  double same_shift_m = 0.05;

  void check() const;
};

}  // namespace limen
