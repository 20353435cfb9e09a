// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/match/openings/match_openings.h"
#include "limen/model/result.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

struct RefineOptions {
  double first_gate_m = 0.12;  ///< surfaces nearer than this are matched in the first round
  double last_gate_m = 0.015;  ///< and in the last
  int rounds = 12;
  std::size_t samples = 0;             ///< of each scan that are used, about; 0: all
  double flatness_m = 0.001;           ///< real walls are not flatter than this: least deviation of a tile
  double first_opening_gate_m = 0.25;  ///< openings nearer than this within their wall are matched at first
  double last_opening_gate_m = 0.06;   ///< and in the last round
  double parallel_rad = 0.003;         ///< by how much the two faces of a wall may not be parallel, 1 sigma
  double wall_thickness_m = 0.0;       ///< of the outer walls, as the user knows it; 0: not known
  double wall_thickness_sigma_m = 0.01;
  bool planes = true;    ///< tiles of surface are matched
  bool openings = true;  ///< openings are matched

  void check() const;
};

/// A pose after least squares, and what the data says of it.
struct RefinedPose {
  Rigid3 target_from_source;           ///< local frames
  Vector3d centre = Vector3d::Zero();  ///< the point known best, near the matched surface; target local frame
  Matrix6d information = Matrix6d::Zero();  ///< of (rotation, translation) about `centre`, target axes, SI
  Matrix6d geometry_m2 = Matrix6d::Zero();  ///< the same with m^2 of surface as weights
  Matrix6d formal_information = Matrix6d::Zero();  ///< as `information`, but every tile errs by itself
  double rms_m = 0.0;                              ///< weighted point-to-plane residual
  int matched_tiles = 0;
  std::vector<PlaneMatch> matches;     ///< pairs of planes with at least two matched tiles
  std::vector<OpeningMatch> openings;  ///< pairs of openings, at the final pose
  std::vector<PlaneMatch> moved;       ///< planes of a model that were probably not built where it has them
};

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

}  // namespace limen
