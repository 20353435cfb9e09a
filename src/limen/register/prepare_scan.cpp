// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare_scan.h"

#include <cmath>
#include <optional>

#include "limen/base/angles.h"
#include "limen/extract/estimate_centre.h"
#include "limen/extract/panorama.h"
#include "limen/extract/voxel_map.h"
#include "limen/match/enumerate_rotations.h"

namespace limen {
namespace {

constexpr double kLevelDeg = 1.0;
constexpr double kLevelShare = 0.1;  // of the planes' area that must be horizontal

bool looks_level(const Features& features) {
  double total = 0.0;
  double horizontal = 0.0;
  for (const AxisDirection& axis : axis_directions(features, 5.0)) {
    total += axis.weight_m2;
    if (std::abs(axis.direction.z()) > std::cos(radians(kLevelDeg))) horizontal += axis.weight_m2;
  }
  return horizontal > kLevelShare * total;
}

/// Turns the normals to the side of `centre`, now that it is known.
void orient(Features& features, const Vector3d& centre) {
  for (PlanarPolygon& polygon : features.planes) {
    polygon.oriented = std::abs(polygon.plane.signed_distance(centre)) > 0.02;
    if (polygon.plane.signed_distance(centre) < 0) polygon = flipped(polygon);
  }
  for (SurfaceSample& sample : features.samples) {
    if (sample.plane >= 0)
      sample.normal = features.planes[static_cast<std::size_t>(sample.plane)].plane.normal;
  }
}

}  // namespace

PreparedScan prepare_scan(const Scan& scan, const ExtractOptions& options, Monitor& monitor) {
  PreparedScan prepared;
  prepared.extracted = extract_features(scan, options, monitor);
  Features& features = prepared.extracted.features;
  prepared.looks_level = looks_level(features);
  std::optional<Vector3d> centre;
  if (scan.centres.size() == 1) {
    centre = scan.centre(0);
  } else if (!scan.centre_known()) {
    if (const std::optional<EstimatedCentre> estimated = estimate_centre(features)) {
      centre = estimated->centre;
      prepared.centre_estimated = true;
      orient(features, *centre);
    }
  }
  if (centre) {
    prepared.space = std::make_unique<Panorama>(scan, prepared.extracted.labels, features, *centre);
  } else {
    prepared.space = std::make_unique<VoxelMap>(scan, features);
  }
  return prepared;
}

}  // namespace limen
