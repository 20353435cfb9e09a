// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/base/progress.h"
#include "limen/extract/grow_planes.h"
#include "limen/extract/make_polygons.h"
#include "limen/extract/sample_surface.h"
#include "limen/model/features.h"

namespace limen {

struct ExtractOptions {
  GrowOptions grow;
  PolygonOptions polygons;
  SampleOptions samples;

  void check() const;
};

/// Features with the plane of every point: Features::planes[labels[i]], or none (-1).
struct ExtractedFeatures {
  Features features;
  std::vector<std::int32_t> labels;
};

/// Planar polygons and surface samples of a scan: the one-call door.
ExtractedFeatures extract_features(const Scan& scan, const ExtractOptions& options = {},
                                   Monitor& monitor = silent_monitor());

}  // namespace limen
