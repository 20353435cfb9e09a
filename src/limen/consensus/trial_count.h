// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limen {

/// Trials after which one sample without outliers was drawn with probability `confidence` (in (0, 1)), where
/// a share `inlier_ratio` of the items are inliers: log(1 - confidence) / log(1 - inlier_ratio^sample_size),
/// rounded up (Fischler and Bolles 1981). At least 1, at most `most`, which is also the answer for ratio 0.
std::size_t trial_count(double inlier_ratio, std::size_t sample_size, double confidence, std::size_t most);

}  // namespace limen
