// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/extract/model/model_edges.h"
#include "limen/extract/model/model_surface.h"
#include "limen/model/features.h"

namespace limen {

struct ModelFeatureOptions {
  ModelSurfaceOptions surface;
  ModelEdgeOptions edges;
  double min_plane_m2 = 0.05;  ///< smaller pieces of surface make edges only, > 0
  double tile_m = 0.25;        ///< edge of the tiles that surface samples stand for, > 0

  void check() const;
};

/// What a model has of what is found in scans, about the model's local origin: its visible surface as planes
/// and samples, both rectangles of every opening of its walls, and its sharp edges as segments (2023, IV-A,
/// and VI for the exact edges). Without noise: `noise_m` is 0 and a sample counts a million points.
struct ModelFeatures {
  Features features;
  std::vector<std::int32_t> elements;  ///< of each plane: index into BimModel::elements
};
ModelFeatures model_features(const BimModel& model, const ModelFeatureOptions& options = {});

}  // namespace limen
