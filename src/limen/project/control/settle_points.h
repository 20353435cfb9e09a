// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/control/point_tests.h"

namespace limen {

/// What the tests made of a point's observations.
struct PointVerdict {
  bool known_left_out = false;  ///< its coordinates are contradicted by all else
  bool suspected = false;       ///< left out, but one of several that may be the wrong one
  double squared = 0.0;         ///< chi square of three freedoms of what was left out
};

struct SettledPoints {
  JointSolution solution;
  std::vector<PointFinding> findings;  ///< of each point of the problem
  std::vector<PointVerdict> verdicts;
  /// False: coordinates contradict one another so that no six freedoms can be trusted; nothing else counts.
  bool firm = true;
  double chi_square = 0.0;  ///< of the points' observations that entered, and how many numbers check them
  double redundancy = 0.0;
};

/// The adjustment with all its points, each tested against all else (data snooping): the observation that
/// misses by most is left out, and all is adjusted anew, until none misses by more than chance explains
/// (point_bounds). Where others explain the contradiction nearly as well (odds of less than a thousand), they
/// are left out too if what remains still holds. Coordinates that do not enter are tried again in the end
/// where `candidates` says so. `problem` keeps what entered.
SettledPoints settle_points(JointProblem& problem, const std::vector<bool>& candidates);

}  // namespace limen
