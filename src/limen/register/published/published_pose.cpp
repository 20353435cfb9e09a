// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/published/published_pose.h"

#include <algorithm>
#include <iterator>

namespace limen {

std::vector<PlanarPolygon> common_polygons(const Features& features, bool outside, std::size_t most) {
  std::vector<PlanarPolygon> common;
  std::copy_if(features.planes.begin(), features.planes.end(), std::back_inserter(common),
               [outside](const PlanarPolygon& polygon) { return polygon.interior == outside; });
  std::stable_sort(common.begin(), common.end(),
                   [](const PlanarPolygon& a, const PlanarPolygon& b) { return a.inliers > b.inliers; });
  if (common.size() > most) common.resize(most);
  return common;
}

}  // namespace limen
