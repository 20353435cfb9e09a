// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// Spherical shells of this thickness are chosen or left out as a whole. Thick ones are steady against the
/// rounding of coordinates, but surfaces square to their radius are in few of them, so that density is lost;
/// thin ones keep it, as chance would. They are halved while fewer than twenty a metre would be chosen.
inline constexpr double kThickShellM = 1e-3;
inline constexpr double kThinShellM = 1e-5;  ///< 32-bit coordinates have steps of 2e-6 m at 20 m

/// Indices of about `most` points of `scan` (all, where there are no more), chosen and ordered by how far
/// they lie from the middle of all: a scan that is moved, turned or whose points come in another order gives
/// the same points in the same order. Dense and sparse parts keep their proportion.
std::vector<std::uint32_t> steady_sample(const Scan& scan, std::size_t most, double shell_m = kThickShellM);

}  // namespace limen
