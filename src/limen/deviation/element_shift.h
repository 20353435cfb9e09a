// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/deviation/deviation.h"

namespace limen {

/// Where the surface before one face is.
struct FaceOffset {
  Vector3d normal = Vector3d::UnitX();
  double offset_m = 0.0;  ///< along the normal
  double sigma_m = 0.0;   ///< standard deviation of the points about it
  std::size_t points = 0;
  /// Another surface may be there as well: another face lies near, or the offset is near the limit.
  bool contested = false;
  double pose_sigma_m = 0.0;  ///< of the scan that saw it, as far as it is known
};

/// Where most points of a face lie: the peak of their distribution, so that what else is within
/// reach of the face, or another element's surface, does not pull.
FaceOffset face_offset(const Vector3d& normal, const std::vector<float>& distances_m, double max_distance_m);

/// The position of a face by several scans, each of which saw it: robustly, the better known poses counting
/// more. One observation still, for how flat a face is no number of scans changes. None: no points.
FaceOffset joined_offset(const std::vector<FaceOffset>& by_scan);

/// Marks faces as contested whose points scatter much more than is typical: their points form no plane.
void contest_scattered(std::vector<FaceOffset>& faces);

/// The rigid shift that explains the offsets of an element's faces, robustly.
ElementShift shift_of(const std::vector<FaceOffset>& faces, const DeviationOptions& options);

}  // namespace limen
