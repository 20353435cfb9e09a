// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "limen/extract/features/extract_features.h"
#include "limen/extract/segments/segments_image.h"

namespace limen {

/// The labels with those points taken in that belong to no plane though they lie on one, among its points:
/// near an edge the surface about a point is not flat, and plane detectors leave it out. `images` are those
/// of the labels.
std::vector<std::int32_t> completed_labels(const Scan& scan, const ExtractedFeatures& extracted,
                                           const std::vector<std::unique_ptr<PlaneImage>>& images);

/// The same scan's features with small planes added among the points of `labels` that have none: window
/// frames, the edges of doors, strips of wall, too small for the plane detector to tell from clutter. An edge
/// tells: what is no straight border of a surface is dropped later.
ExtractedFeatures with_small_planes(const Scan& scan, const ExtractedFeatures& extracted,
                                    std::vector<std::int32_t> labels, int min_points, Monitor& monitor);

}  // namespace limen
