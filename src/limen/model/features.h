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

/// A window or door as a rectangle in its wall (2022, section 2). Coordinates about the scan's local origin.
struct Opening {
  Vector3d corners[4];       ///< in order round the rectangle, metres
  int facade = -1;           ///< index into Features::planes of the wall it lies in
  std::size_t evidence = 0;  ///< rays that crossed the wall plane inside it
};

/// A small piece of surface: the mean of the points in one tile of a plane, or of one cube of clutter.
struct SurfaceSample {
  Vector3d mean = Vector3d::Zero();    ///< metres, about the scan's local origin
  Vector3d normal = Vector3d::Zero();  ///< of its plane, towards the scanner where known; zero for clutter
  std::int32_t plane = -1;             ///< index into Features::planes, or -1
  float area_m2 = 0.0F;                ///< surface it stands for
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
};

}  // namespace limen
