// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/geometry/polygon.h"
#include "limen/geometry/segment.h"
#include "limen/model/scan.h"

namespace limen {

/// How an opening was noticed.
enum class OpeningView : std::uint8_t {
  through,  ///< rays came back from well beyond the wall
  recess,   ///< rays only came back from a little behind the wall: a blind, a shutter, a closed door
  hole      ///< the wall was not measured there: a curtain hangs before it, or nothing came back
};
const char* to_string(OpeningView view);

/// A window or door as an upright rectangle in its wall (2022, section 2). Coordinates about the scan's local
/// origin. Seen from the scanner's side of the wall the corners are lower left, lower right, upper right,
/// upper left; edge k runs from corner k to corner (k + 1) % 4: bottom, right, top, left.
struct Opening {
  Vector3d corners[4];       ///< in order round the rectangle, metres, in the plane of the wall
  int facade = -1;           ///< index into Features::planes of the wall it lies in
  std::size_t evidence = 0;  ///< rays that crossed the wall plane inside it and came back from behind
  OpeningView view = OpeningView::through;
  /// One standard deviation of each edge's place, across the edge within the wall, metres. An edge that was
  /// not seen (hidden by a tree, cut off by the scan's border) has 1 or more.
  double edge_sigma_m[4] = {1.0, 1.0, 1.0, 1.0};
  double reveal_depth_m = 0.0;  ///< how far the sides of the opening reach behind the wall; 0: not seen
  double reveal_sigma_m = 0.0;  ///< one standard deviation of it
  /// The sides end there: the depth is the wall's thickness, not a lower bound.
  bool reveal_complete = false;
  /// The seen outline in the wall where it is not a rectangle (arched, round).
  std::vector<Vector3d> outline;

  [[nodiscard]] Vector3d middle() const { return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]); }
};

/// A small piece of surface: the mean of the points in one tile of a plane, or of one cube of clutter.
struct SurfaceSample {
  Vector3d mean = Vector3d::Zero();    ///< metres, about the scan's local origin
  Vector3d normal = Vector3d::Zero();  ///< of its plane, towards the scanner where known; zero for clutter
  std::int32_t plane = -1;             ///< index into Features::planes, or -1
  float area_m2 = 0.0F;                ///< surface it represents
  float count = 0.0F;                  ///< points averaged
};

/// All that is taken from one scan, about that scan's local origin. Types only: who makes them is in
/// extract/.
struct Features {
  Vector3d local_origin = Vector3d::Zero();  ///< copied from the scan: x_in_world = local_origin + x
  std::vector<PlanarPolygon> planes;         ///< most inliers first
  std::vector<Opening> openings;
  std::vector<Segment> segments;
  std::vector<SurfaceSample> samples;  ///< evenly spread over the seen surface, planes first
  double inlier_threshold_m = 0.0;     ///< the distance threshold that was used or chosen
  double noise_m = 0.0;                ///< estimated range noise, one standard deviation
  /// What a whole plane may be off, one standard deviation per axis: the slow error of a mobile scan's
  /// trajectory, as the surface of its large planes shows it (with their relief), and coarse coordinates; 0
  /// for other static scans.
  double drift_m = 0.0;
};

}  // namespace limen
