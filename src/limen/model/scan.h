// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/scanner_place.h"

namespace limen {

/// The place of each point in the order the scanner measured: profile (or column) and pulse within it.
/// Both arrays have one entry per point, or are empty where the order is unknown.
struct ScanTopology {
  std::vector<std::int32_t> line;   ///< profile of a mobile scan, column of a static one
  std::vector<std::int32_t> index;  ///< pulse within the line, row of a static scan
  [[nodiscard]] bool known() const { return !line.empty(); }
};

/// A laser scan: points about a local origin, and from where they were seen.
///
/// x_in_world = local_origin + point; the origin is a round number near the data, so that a millimetre
/// survives national grid coordinates of 6.8e6 m. Missing returns are not kept.
struct Scan {
  std::string name;                          ///< for messages and reports
  Vector3d local_origin = Vector3d::Zero();  ///< metres, world
  std::vector<Vector3d> points;              ///< metres, about local_origin
  /// Optical centres, metres, about local_origin. Empty: unknown; one: a static station; one per point:
  /// mobile.
  std::vector<Vector3d> centres;
  /// Who says so, of a static station; a claim that is tested before it is believed.
  PlaceSource centre_source = PlaceSource::stated_by_file;
  ScanTopology topology;
  std::vector<double> times_s;        ///< per point or empty (GPS time, seconds)
  std::vector<float> intensities;     ///< per point or empty, in the file's unit
  std::vector<std::uint8_t> colours;  ///< 3 per point (red, green, blue) or empty
  /// True where the frame's z axis is known to point up (level scanner, national grid); false: unknown.
  bool level = false;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool centre_known() const { return !centres.empty(); }
  [[nodiscard]] bool mobile() const { return centres.size() > 1; }
  /// The scanner position of point i; call only where centre_known().
  [[nodiscard]] const Vector3d& centre(std::size_t i) const {
    return centres.size() > 1 ? centres[i] : centres[0];
  }

  /// Throws Error(Fault::internal) where array sizes disagree.
  void check() const;
};

/// A scan and its known place among others: x_in_group = group_from_scan * x, world coordinates, metres.
struct PlacedScan {
  Scan scan;
  Rigid3 group_from_scan;
};

/// The points of `scan` with the given indices, all attributes kept, in the given order.
Scan subset(const Scan& scan, const std::vector<std::uint32_t>& indices);

/// The scan's points and scanner positions moved about the local origin, which stays.
Scan moved(Scan scan, const Rigid3& motion);

/// A round number (100 m) near `x`, or 0,0,0 where all coordinates are below 10 km.
Vector3d round_origin_near(const Vector3d& x);

/// A scan of points alone, metres, in any frame. Throws Error where there is none, or one is not finite.
Scan scan_of_points(std::vector<Vector3d> points);

/// A round place near the points, world: the local origin where they lie within 1 km of it. Turns about a far
/// origin would amplify the smallest angle.
Vector3d origin_near(const Scan& scan);

/// No scanner reaches farther.
inline constexpr double kFarthestRangeM = 2e4;
/// Median distance of points to their scanner positions, of a thousand points; metres. The scan knows its
/// scanner positions.
double median_range(const Scan& scan);

/// Axis-aligned extent of the points about local_origin; two zero vectors for an empty scan.
struct Extent {
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();
  [[nodiscard]] double diagonal() const { return (high - low).norm(); }
};
Extent extent_of(const std::vector<Vector3d>& points);

/// Lowest and highest signed distance of a box to a plane.
std::pair<double, double> signed_distances(const Plane& plane, const Extent& box);

}  // namespace limen
