// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "limen/sight/surface_columns.h"

namespace limen {

/// What a view of space says to a batch of samples of another scan, m^2 of each.
struct Answers {
  std::array<float, kLookBatch> gain_m2;  ///< agreeing surface, 1 - d^2 / t^2 of the area
  std::array<float, kLookBatch> contradicted_m2;
};

/// `areas_m2`, `planar`: of the `size` samples looked at, at most kLookBatch.
void weigh_looks(const Looks& looks, const float* areas_m2, const std::int32_t* planar,
                 const LookTolerances& tolerances, std::size_t size, Answers& answers);

}  // namespace limen
