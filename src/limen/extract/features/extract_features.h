// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/extract/planes/detect_planes.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/extract/surface/facades.h"
#include "limen/extract/surface/interior_points.h"
#include "limen/extract/surface/make_polygons.h"
#include "limen/extract/surface/sample_surface.h"
#include "limen/model/features.h"

namespace limen {

/// Planes that a scan sees through the openings of its walls: a mobile scan those inside a building (2021,
/// 3.1), a station those outside it, or in the next room (2021, section 5: future work).
struct InteriorOptions {
  bool enabled = true;
  int min_inliers = 40;                       ///< smallest plane among the points behind walls
  FacadeCriteria facades;                     ///< walls of a mobile scan
  FacadeCriteria walls{0.05, 2.0, 1.2, 0.8};  ///< walls of a station
  InteriorPointOptions points;

  void check() const;
};

struct ExtractOptions {
  DetectOptions detect;
  GrowOptions grow;  ///< its threshold and smallest plane hold for every detector
  InteriorOptions interior;
  PolygonOptions polygons;
  SampleOptions samples;

  void check() const;
};

/// Features with the plane of every point: Features::planes[labels[i]], or none (-1).
struct ExtractedFeatures {
  Features features;
  std::vector<std::int32_t> labels;
  std::vector<int> facades;  ///< indices of the planes that are façades, or walls of a station
};

/// Planar polygons and surface samples of a scan: the one-call door.
ExtractedFeatures extract_features(const Scan& scan, const ExtractOptions& options = {},
                                   Monitor& monitor = silent_monitor());

}  // namespace limen
