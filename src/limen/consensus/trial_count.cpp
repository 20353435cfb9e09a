// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/consensus/trial_count.h"

#include <algorithm>
#include <cmath>

#include "limen/base/error.h"

namespace limen {

std::size_t trial_count(double inlier_ratio, std::size_t sample_size, double confidence, std::size_t most) {
  if (!(confidence > 0.0 && confidence < 1.0)) throw_bad_option("confidence", confidence, "in (0, 1)");
  const double good = std::pow(std::clamp(inlier_ratio, 0.0, 1.0), static_cast<double>(sample_size));
  if (good >= 1.0) return 1;
  // log1p keeps what 1 - good would lose for a ratio of a thousandth.
  const double trials = std::ceil(std::log1p(-confidence) / std::log1p(-good));
  if (!(trials < static_cast<double>(most))) return std::max<std::size_t>(1, most);
  return std::max<std::size_t>(1, static_cast<std::size_t>(trials));
}

}  // namespace limen
