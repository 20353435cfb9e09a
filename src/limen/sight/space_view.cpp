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
  for (std::size_t k = 0; k < size; ++k) {
    const Vector3d at = view_from_scan * asked.place(begin + k);
    const Sight sight = look(query_of(asked, begin + k, at, view_from_scan, tolerances));
    looks.kind[k] = static_cast<std::int32_t>(sight.kind);
    looks.plane[k] = sight.plane;
    looks.distance_m[k] = static_cast<float>(sight.distance_m);
  }
}

}  // namespace limen
