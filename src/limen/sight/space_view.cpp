// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/space_view.h"

#include <algorithm>
#include <array>

namespace limen {

std::vector<Facet> facets_of(const Features& features) {
  std::vector<Facet> facets;
  facets.reserve(features.planes.size());
  for (const PlanarPolygon& polygon : features.planes) facets.push_back({polygon.plane, polygon.oriented});
  return facets;
}

SightQuery query_of(const SurfaceColumns& asked, std::size_t i, const Vector3d& at,
                    const Rigid3& view_from_scan, const LookTolerances& tolerances) {
  const bool planar = asked.planar[i] != 0;
  SightQuery query;
  query.at = at;
  if (planar) query.normal = view_from_scan.rotation * asked.normal(i);
  query.oriented = asked.oriented[i] != 0.0F;
  query.surface_m = planar ? tolerances.surface_m : tolerances.clutter_m;
  query.free_m = tolerances.free_m;
  return query;
}

void SpaceView::look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                                const Rigid3& view_from_scan, const LookTolerances& tolerances,
                                Looks& looks) const {
  std::array<SightQuery, kSightBatch> queries;
  std::array<Sight, kSightBatch> sights;
  for (std::size_t done = 0; done < size; done += kSightBatch) {
    const std::size_t count = std::min(kSightBatch, size - done);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + done + k;
      queries[k] = query_of(asked, i, view_from_scan * asked.place(i), view_from_scan, tolerances);
    }
    look_all({queries.data(), count}, {sights.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      looks.kind[done + k] = static_cast<std::int32_t>(sights[k].kind);
      looks.distance_m[done + k] = static_cast<float>(sights[k].distance_m);
    }
  }
}

}  // namespace limen
