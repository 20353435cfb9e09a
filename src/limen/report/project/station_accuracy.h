// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

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

/// Whether anything checks the link: a single unchecked one has no residual.
inline bool is_checked(const ProjectLink& link) {
  constexpr double kNothing = 1e-6;
  if (link.solved.state == LinkState::bridge) return false;
  if (link.solved.state == LinkState::in_place) return true;
  if (link.solved.pose < 0 && link.solved.state != LinkState::verified) return link.solved.loop_error_m > 0.0;
  return link.solved.state == LinkState::verified || link.solved.redundancy > kNothing;
}

/// In how many loops that close a link is.
std::size_t loops_through(const ProjectResult& result, std::size_t link);

/// Whether what a link misses the solution by is within what is asked of stations; nothing where nothing is
/// asked, and of a link that no loop checks or that was rejected.
std::optional<bool> within_tolerance(const ProjectResult& result, const ProjectLink& link);

/// Distances between matched planes after the adjustment of the whole.
struct BundleError {
  double rms_m = 0.0;      ///< over all accepted links, by overlap; passes that were bent aside
  std::size_t planes = 0;  ///< pairs of them
  std::size_t worst = 0;   ///< the link with the largest RMS ...
  double worst_rms_m = 0.0;
};
std::optional<BundleError> bundle_error(const ProjectResult& result);

/// Indices of scans: first those that are in doubt or unknown, then by the radius, the largest first; the one
/// held fixed and models last.
std::vector<std::size_t> worst_scans_first(const ProjectResult& result);

/// Indices of links: first what is in doubt, then single unchecked, then verified ones by their residual, the
/// largest first; last what does not count.
std::vector<std::size_t> worst_links_first(const ProjectResult& result);

/// Share of the planes of the smaller of a link's scans that agree with planes of the other one, by area, at
/// the pair's own best pose; nothing where another pose was taken.
std::optional<double> overlap_of(const ProjectResult& result, std::size_t link);

}  // namespace limen
