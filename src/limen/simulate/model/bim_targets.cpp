// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/simulate/model/bim_changes.h"
#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/whole/site_targets.h"

namespace limen {

namespace {

/// The station that is farthest from all these places; the first where there are none.
const Vector3d& farthest_station(const std::vector<BimStation>& stations,
                                 const std::vector<SiteTarget>& places) {
  const auto away = [&](const BimStation& station) {
    double least = 1e300;
    for (const SiteTarget& place : places) least = std::min(least, (place.centre - station.position).norm());
    return least;
  };
  return std::max_element(stations.begin(), stations.end(),
                          [&](const BimStation& a, const BimStation& b) { return away(a) < away(b); })
      ->position;
}

}  // namespace

std::vector<SiteTarget> put_up_spheres(BimMesh& built, const std::vector<BimStation>& stations,
                                       std::size_t count, RandomStream& random) {
  constexpr std::size_t kTogether = 3;
  constexpr int kAttempts = 2000;
  std::vector<SiteTarget> targets;
  if (count == 0) return targets;
  const Mesh bare = built.mesh;
  const RayCaster caster(bare);
  Vector3d scanner;
  for (int attempt = 0; targets.size() < count && attempt < kAttempts; ++attempt) {
    if (targets.size() % kTogether == 0) scanner = farthest_station(stations, targets);
    const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d way(std::cos(azimuth), std::sin(azimuth), random.uniform(-0.3, 0.2));
    const Vector3d centre = scanner + random.uniform(0.8, 1.3) * way;
    const RayHit sight = caster.cast(scanner, way.normalized());
    const RayHit floor = caster.cast(centre, -Vector3d::UnitZ());
    if ((sight.found() && sight.range_m < (centre - scanner).norm()) || !floor.found() ||
        floor.range_m > 2.5 || !has_room_for_sphere(caster, centre, targets))
      continue;
    add_sphere_on_pole(built.mesh, centre, centre.z() - floor.range_m);
    targets.push_back({fmt::format("S{}", targets.size() + 1), centre});
  }
  if (targets.size() < count)
    throw Error(fmt::format("there is a place for {} targets only", targets.size()), "limen simulate",
                "ask for no more --targets");
  built.element_of_surface.resize(built.mesh.surfaces().size(), -1);
  return targets;
}

}  // namespace limen
