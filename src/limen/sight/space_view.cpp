// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/space_view.h"

namespace limen {

std::vector<Facet> facets_of(const Features& features) {
  std::vector<Facet> facets;
  facets.reserve(features.planes.size());
  for (const PlanarPolygon& polygon : features.planes) facets.push_back({polygon.plane, polygon.oriented});
  return facets;
}

}  // namespace limen
