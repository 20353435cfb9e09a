// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/space_view.h"

#include <cmath>

namespace limen {
namespace {

constexpr double kSameNormal = 0.94;  // cosine: about 20 degrees

}  // namespace

std::vector<Facet> facets_of(const Features& features) {
  std::vector<Facet> facets;
  facets.reserve(features.planes.size());
  for (const PlanarPolygon& polygon : features.planes) facets.push_back({polygon.plane, polygon.oriented});
  return facets;
}

std::optional<double> distance_if_same(const SightQuery& query, const Facet& facet) {
  const double distance = facet.plane.signed_distance(query.at);
  if (std::abs(distance) > query.surface_m) return std::nullopt;
  if (!query.normal.isZero()) {
    const double cosine = query.normal.dot(facet.plane.normal);
    if ((query.oriented && facet.oriented ? cosine : std::abs(cosine)) < kSameNormal) return std::nullopt;
  }
  return distance;
}

}  // namespace limen
