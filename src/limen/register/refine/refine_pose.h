// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/match/openings/match_openings.h"
#include "limen/model/result.h"
#include "limen/register/options/pair_options.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

/// A pose after least squares, and what the data says of it.
struct RefinedPose {
  Rigid3 target_from_source;           ///< local frames
  Vector3d centre = Vector3d::Zero();  ///< the point known best, near the matched surface; target local frame
  Matrix6d information = Matrix6d::Zero();  ///< of (rotation, translation) about `centre`, target axes, SI
  Matrix6d geometry_m2 = Matrix6d::Zero();  ///< the same with m^2 of surface as weights
  Matrix6d formal_information = Matrix6d::Zero();  ///< as `information`, but every tile errs by itself
  double rms_m = 0.0;                              ///< weighted point-to-plane residual
  std::vector<PlaneMatch> matches;                 ///< pairs of planes with at least two matched tiles
  std::vector<OpeningMatch> openings;              ///< pairs of openings, at the final pose
  /// Planes of a model that were probably not built where it has them; of two scans, planes that lie beside
  /// their counterparts.
  std::vector<PlaneMatch> moved;
  /// Mean square by which poses about `centre` differ that take other planes for the moved ones; of a model
  /// it is part of the information.
  Matrix6d spread = Matrix6d::Zero();
};

/// All of a pose that turns with the target's axes.
inline std::array<Matrix6d*, 4> about_centre(RefinedPose& pose) {
  return {&pose.information, &pose.geometry_m2, &pose.formal_information, &pose.spread};
}

/// Covariance of (rotation, translation) about `pose.centre`, target axes, SI; a freedom that nothing holds
/// has a deviation of 1000 m or radians.
Matrix6d covariance_of(const RefinedPose& pose);

/// The same of the scatter of the tiles alone: how far the planes of a pair lie apart is left out.
Matrix6d formal_covariance_of(const RefinedPose& pose);

/// The pose of the target in the source, with all that is known of it: turns and shifts of the target about
/// `centre` are those of the source about the same point, the other way round and in the source's axes.
RefinedPose inverted(const RefinedPose& pose);

/// Robust point-to-plane adjustment over all matched surface of both scans, both ways: each tile of one scan
/// against the plane of the other that its scanner saw there (2021, 3.4: "then refine on all matched
/// planes"). Matched openings enter with the shifts of their edges within the wall, with the wall's two faces
/// being parallel and, where the thickness is known or a reveal was seen to its end, with the gap between
/// the faces (2023, III-B).
RefinedPose refine_pose(const ScanView& source, const ScanView& target, const Rigid3& start,
                        const RefineOptions& options);

/// Finds the planes of two scans that lie centimetres beside their counterparts under a refined pose, as
/// where a floor was laid or a wall was lined between the scans: `moved` and `spread` of the pose. Which
/// planes moved is not known, so that every pose that has most of them in place is likely.
void find_moved(const ScanView& source, const ScanView& target, const RefineOptions& options,
                RefinedPose& pose);

}  // namespace limen
