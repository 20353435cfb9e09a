// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/match/enumerate_hybrid_poses.h"

namespace limen {

struct WallThicknessOptions {
  OpeningPoseOptions openings;             ///< which openings are one, and which thicknesses are possible
  std::optional<double> wall_thickness_m;  ///< given by the user, > 0
  double user_sigma_m = 0.02;              ///< one standard deviation of that, > 0
  double pose_sigma_m = 0.005;             ///< of the pose along the wall's normal where planes hold it, > 0
  double plane_sigma_m = 0.003;            ///< least error of a plane's place, on top of its noise, > 0
  double plane_tolerance_m = 0.08;         ///< planes of both scans nearer than this are one, > 0

  void check() const;
};

/// The thickness of one wall between the two scans.
struct WallThickness {
  double value_m = 0.0;
  double sigma_m = 0.0;                               ///< one standard deviation
  ThicknessSource source = ThicknessSource::assumed;  ///< the strongest evidence there is
  int source_wall = -1;                               ///< index into the source's planes, or -1
  int target_wall = -1;
  int openings = 0;  ///< that pair the two faces
  /// The reveals' own word on it, metres, where any reached through; to be compared with `value_m`.
  std::optional<double> from_reveals_m;
};

/// For every wall whose two faces openings bring together at this pose: how thick it is. Where planes seen by
/// both scans (or openings in another wall) hold the pose along the wall's normal, it is the distance between
/// the faces; reveals that reach through, and the user's figure, are independent measures of it. All are
/// combined by their deviations, contradicting ones left out. A wall of which nothing is known but the pose
/// is listed as `assumed` with the range's deviation: its thickness is not observed. Walls with most openings
/// first.
std::vector<WallThickness> estimate_thickness(const Features& source, const Features& target,
                                              const Rigid3& target_from_source,
                                              const WallThicknessOptions& options = {});

}  // namespace limen
