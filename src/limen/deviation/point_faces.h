// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/deviation/deviation.h"
#include "limen/geometry/face_index.h"

namespace limen {

/// A scan in the model's local frame.
struct ScanInModel {
  std::vector<Vector3d> points;
  std::vector<Vector3d> centres;  ///< as Scan::centres

  ScanInModel(const Scan& scan, const Rigid3& model_from_scan);
  [[nodiscard]] bool centre_known() const { return !centres.empty(); }
  [[nodiscard]] const Vector3d& centre(std::size_t i) const {
    return centres.size() > 1 ? centres[i] : centres[0];
  }
};

/// The face that each point lies on.
struct PointFaces {
  std::vector<std::int32_t> face;  ///< index into the index's faces, or -1
  std::vector<float> distance_m;   ///< signed; NaN where there is no face
  std::vector<char> far;           ///< 1: no face of any direction within reach
  /// Of every kGapStride-th point: how far behind or before its face another lies that it might be on
  /// instead; NaN where there is none within reach.
  std::vector<float> gap_m;
  static constexpr std::size_t kGapStride = 8;
};

/// The nearest face whose front the scanner saw and whose direction is that of the surface at the point.
/// Where points are too sparse for a direction, the nearest that could be seen; at edges and in clutter,
/// where the surface has no direction, none.
PointFaces lay_on_faces(const ScanInModel& scan, const FaceIndex& index, const DeviationOptions& options,
                        Monitor& monitor);

}  // namespace limen
