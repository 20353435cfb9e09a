// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/plane_labels.h"

namespace limen {

std::vector<std::vector<std::uint32_t>> points_of(const std::vector<std::int32_t>& labels,
                                                  std::size_t planes) {
  std::vector<std::size_t> counts(planes, 0);
  for (const std::int32_t label : labels) {
    if (label >= 0) ++counts[static_cast<std::size_t>(label)];
  }
  std::vector<std::vector<std::uint32_t>> points(planes);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].reserve(counts[k]);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] >= 0) points[static_cast<std::size_t>(labels[i])].push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

}  // namespace limen
