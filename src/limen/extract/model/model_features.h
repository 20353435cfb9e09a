// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/bim_model.h"
#include "limen/model/features.h"

namespace limen {

/// What a model has of what is found in scans, about the model's local origin: its visible surface as planes
/// and samples, both rectangles of every opening of its walls, and its sharp edges as segments (2023, IV-A,
/// and VI for the exact edges). Without noise: `noise_m` is 0 and a sample counts a million points.
struct ModelFeatures {
  Features features;
  std::vector<std::int32_t> elements;  ///< of each plane: index into BimModel::elements
};
/// `tile_m`: edge of the tiles that surface samples stand for.
ModelFeatures model_features(const BimModel& model, double tile_m = 0.25);

}  // namespace limen
