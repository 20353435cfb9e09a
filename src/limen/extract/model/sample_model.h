// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/extract/segments/segments.h"
#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

// Monasse, Djahel, Vallet 2023, section IV-A: a model's line segments are found in a cloud of points that are
// spread over its surface by Poisson-disk sampling, with the detector that is used for scans.
//
// Departures: the surface is that which borders on air (model_surface.h), or points inside walls would make
// planes of their own; the exact edges of the model (model_edges.h, the paper's future work) are the default
// everywhere else.

namespace limen {

struct ModelSamplingOptions {
  double spacing_m = 0.04;  ///< no two points are nearer than this, > 0
  std::uint64_t seed = 1;
};

/// Points on the visible surface of a model, none nearer than the spacing to another, hardly anywhere room
/// for one more. The scanner position is unknown. Deterministic. Throws Error where the model is too large
/// for the spacing.
Scan sample_model(const BimModel& model, const ModelSamplingOptions& options = {});

/// The segments that the detector for scans finds in such a cloud, about the model's local origin.
std::vector<Segment> sampled_model_segments(const BimModel& model, const ModelSamplingOptions& sampling = {},
                                            const SegmentOptions& options = {});

}  // namespace limen
