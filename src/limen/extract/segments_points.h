// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limen/extract/extract_features.h"
#include "limen/extract/segments_image.h"

namespace limen {

/// The labels with those points taken in that belong to no plane though they lie on one, among its points:
/// near an edge the surface about a point is not flat, and plane detectors leave it out. `images` are those
/// of the labels.
std::vector<std::int32_t> completed_labels(const Scan& scan, const ExtractedFeatures& extracted,
                                           const std::vector<std::unique_ptr<PlaneImage>>& images);

}  // namespace limen
