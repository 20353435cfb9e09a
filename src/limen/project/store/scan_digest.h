// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/project/store/prepared_bytes.h"
#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// A plane as the joint adjustment needs it, in the scan's own axes about the digest's origin.
struct PlaneDigest {
  Plane plane;
  Vector3d centroid = Vector3d::Zero();
  double area_m2 = 0.0;
  bool oriented = false;
  bool interior = false;
  PointMoments moments;  ///< of its tiles, one point each, about `centroid`
};

/// What choosing pairs and the joint adjustment need of a scan: small enough that those of all scans lie in
/// memory at once.
struct ScanDigest {
  /// Of everything here: near the middle of the scan, not the origin of its features. Metres, world.
  Vector3d local_origin = Vector3d::Zero();
  bool mobile = false;
  bool upright = false;
  bool surely_upright = false;  ///< no other way up need be tried
  bool model = false;
  Matrix3d upright_from_scan = Matrix3d::Identity();
  std::vector<Vector3d> stations;      ///< about the local origin, scan's axes
  Vector3d middle = Vector3d::Zero();  ///< of the samples, about the local origin, scan's axes
  double noise_m = 0.0;
  double drift_m = 0.0;
  std::vector<PlaneDigest> planes;
  std::vector<Vector2d> openings;  ///< width and height of each
  PassTrack track;                 ///< about the local origin, scan's axes

  [[nodiscard]] FeatureCounts counts() const { return {planes.size(), openings.size()}; }
  /// Where the scanner of a static scan was, about the local origin, if that is known.
  [[nodiscard]] std::optional<Vector3d> scanner() const {
    return !mobile && stations.size() == 1 ? std::optional(stations.front()) : std::nullopt;
  }
};

ScanDigest digest_of(const PreparedScan& prepared);

std::string bytes_of(const ScanDigest& digest);
/// Throws Error where the bytes are damaged; `where` is in the message.
ScanDigest digest_from(std::string_view bytes, const std::string& where);

}  // namespace limen
