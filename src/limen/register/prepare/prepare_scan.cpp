// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_scan.h"

#include <cmath>
#include <optional>

#include "limen/base/angles.h"
#include "limen/base/stage_part.h"
#include "limen/extract/features/scanner_up.h"
#include "limen/extract/openings/openings.h"
#include "limen/extract/segments/segments.h"
#include "limen/match/planes/enumerate_rotations.h"
#include "limen/sight/estimate_centre.h"
#include "limen/sight/panorama.h"
#include "limen/sight/voxel_map.h"

namespace limen {
namespace {

constexpr double kLevelDeg = 1.0;
constexpr double kNearlyLevelDeg = 3.0;  // a level scanner may be off by this: its own z is as good
constexpr double kLevelShare = 0.1;      // of the planes' area that must be horizontal

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

/// The smallest turn that brings `up` to z; none where it is there already.
Matrix3d turn_upright(const Vector3d& up) {
  if (up.z() > std::cos(radians(kNearlyLevelDeg))) return Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix();
}

constexpr double kExtracted = 0.75;  // shares of the work, about, by which progress is told
constexpr double kSpaceKnown = 0.85;

/// Everything but the question of the vertical: z points up where `upright`.
void prepare(const Scan& scan, const ExtractOptions& options, PreparedScan& prepared, Monitor& monitor) {
  ExtractOptions used = options;
  used.interior.enabled = options.interior.enabled && (prepared.upright || scan.mobile());
  StagePart extracting(monitor, 0.0, kExtracted);
  prepared.extracted = extract_features(scan, used, extracting);
}

/// The optical centre, the view of space, what is seen through openings, the openings, and the segments.
void look_around(const Scan& scan, const PrepareOptions& options, PreparedScan& prepared, Monitor& monitor) {
  Features& features = prepared.extracted.features;
  Scan placed;
  const Scan* seen = &scan;
  if (!scan.centre_known()) {
    if (const std::optional<EstimatedCentre> estimated = estimate_centre(features)) {
      prepared.centre_estimated = true;
      orient(features, estimated->centre);
      placed = scan;
      placed.centres = {estimated->centre};
      seen = &placed;
      if (prepared.upright) add_seen_through(placed, options.extract, prepared.extracted, monitor);
    }
  }
  if (seen->centres.size() == 1) {
    prepared.space = std::make_unique<Panorama>(*seen, prepared.extracted.labels, features, seen->centre(0));
    prepared.stations = seen->centres;
  } else {
    prepared.space = std::make_unique<VoxelMap>(*seen, features);
  }
  monitor.advance(kSpaceKnown, 1.0);
  if (prepared.upright && seen->centre_known())
    features.openings = find_openings(*seen, prepared.extracted, Vector3d::UnitZ(), {}, monitor);
  if (options.segments) features.segments = find_segments(*seen, prepared.extracted, {}, monitor);
  prepared.settle_reach();
}

constexpr double kReachM = 0.3;  // beyond the samples

}  // namespace

void PreparedScan::settle_reach() {
  reach.setEmpty();
  for (const SurfaceSample& sample : extracted.features.samples) reach.extend(sample.mean);
  reach.min().array() -= kReachM;
  reach.max().array() += kReachM;
  if (model) runs = SampleRuns(extracted.features.samples);
}

PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options, Monitor& monitor) {
  const CancelScope scope(monitor);
  PreparedScan prepared;
  prepared.upright = options.gravity == Gravity::up;
  prepared.mobile = scan.mobile();
  if (options.gravity != Gravity::unknown) {
    prepare(scan, options.extract, prepared, monitor);
    if (!prepared.upright && looks_level(prepared.extracted.features)) {
      prepared.upright = true;
      if (scan.centres.size() == 1) add_seen_through(scan, options.extract, prepared.extracted, monitor);
    }
    if (prepared.upright) {
      look_around(scan, options, prepared, monitor);
      return prepared;
    }
  }
  const std::optional<Vector3d> up = find_scanner_up(scan, monitor);
  if (up) {
    prepared.upright = true;
    prepared.upright_from_scan = turn_upright(*up);
    if (!prepared.upright_from_scan.isIdentity()) {
      const Scan copy = moved(scan, {prepared.upright_from_scan, Vector3d::Zero()});
      prepare(copy, options.extract, prepared, monitor);
      look_around(copy, options, prepared, monitor);
      return prepared;
    }
  }
  if (up || options.gravity == Gravity::unknown) prepare(scan, options.extract, prepared, monitor);
  look_around(scan, options, prepared, monitor);
  return prepared;
}

}  // namespace limen
