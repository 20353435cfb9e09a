// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "limen/project/result/project_result.h"

namespace limen {

/// How well the place of a scan is known in its frame, as an office hands it in.
struct StationAccuracy {
  bool held_fixed = false;               ///< the sigmas of all others are against this one
  Vector3d sigma_m = Vector3d::Zero();   ///< along the frame's axes
  double heading_sigma_rad = 0.0;        ///< about the vertical
  double radius_m = 0.0;                 ///< holds the place in 95 % of cases
  int loa = 0;                           ///< class of the USIBD by that radius, 50 to 10; 0: none
  std::optional<bool> within_tolerance;  ///< where one was asked for
};

/// Nothing of a scan that is in no frame, and of models. `scan`: index into the result's.
std::optional<StationAccuracy> accuracy_of(const ProjectResult& result, std::size_t scan);

/// Whether a loop checks the link: a single unchecked one has no residual.
inline bool is_checked(const ProjectLink& link) {
  return link.solved.state != LinkState::bridge;
}

/// How many loops of the result a link is part of.
std::size_t loops_through(const ProjectResult& result, std::size_t link);

/// Whether what a link misses the solution by is within what is asked of stations; nothing where nothing is
/// asked, and of a link that no loop checks.
std::optional<bool> within_tolerance(const ProjectResult& result, const ProjectLink& link);

/// Share of the planes of the smaller of a link's scans that agree with planes of the other one, by area, at
/// the pair's own best pose; nothing where another pose was taken.
std::optional<double> overlap_of(const ProjectResult& result, std::size_t link);

}  // namespace limen
