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

void SpaceView::look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                                const Rigid3& view_from_scan, const LookTolerances& tolerances,
                                Looks& looks) const {
  std::array<SightQuery, kSightBatch> queries;
  std::array<Sight, kSightBatch> sights;
  const Matrix3d& turn = view_from_scan.rotation;
  for (std::size_t done = 0; done < size; done += kSightBatch) {
    const std::size_t count = std::min(kSightBatch, size - done);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + done + k;
      const bool planar = asked.planar[i] != 0;
      queries[k].at = turn * Vector3d(asked.x[i], asked.y[i], asked.z[i]) + view_from_scan.translation;
      queries[k].normal = turn * Vector3d(asked.nx[i], asked.ny[i], asked.nz[i]);
      queries[k].oriented = asked.oriented[i] != 0.0F;
      queries[k].surface_m = planar ? tolerances.surface_m : tolerances.clutter_m;
      queries[k].free_m = tolerances.free_m;
    }
    look_all({queries.data(), count}, {sights.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      looks.kind[done + k] = static_cast<std::int32_t>(sights[k].kind);
      looks.distance_m[done + k] = static_cast<float>(sights[k].distance_m);
    }
  }
}

}  // namespace limen
