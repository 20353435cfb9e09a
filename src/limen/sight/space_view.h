// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/model/features.h"
#include "limen/sight/surface_columns.h"

namespace limen {

/// What a scanner knows of a place in space.
enum class SightKind : std::uint8_t {
  unseen,   ///< no ray came near
  free,     ///< rays passed through: nothing solid stood there
  surface,  ///< a surface was measured there
  hidden    ///< behind a measured surface
};

struct Sight {
  SightKind kind = SightKind::unseen;
  std::int32_t plane = -1;  ///< for surface: index of the plane it lies on, or -1 for clutter
  double distance_m = 0.0;  ///< for surface on a plane: signed distance to that plane
};

/// What is asked of a place: its surface, and the tolerances.
struct SightQuery {
  Vector3d at = Vector3d::Zero();      ///< about the scan's local origin
  Vector3d normal = Vector3d::Zero();  ///< of the surface asked for; zero: clutter, any surface will do
  bool oriented = false;               ///< the normal's sign counts
  double surface_m = 0.05;             ///< a surface nearer than this is the same surface
  double free_m = 0.10;                ///< surface is contradicted where rays passed this much beyond

  [[nodiscard]] bool of_clutter() const { return normal.squaredNorm() < 0.25; }
};

/// What the i-th piece of `asked` asks where `view_from_scan` lays it, at `at`.
SightQuery query_of(const SurfaceColumns& asked, std::size_t i, const Vector3d& at,
                    const Rigid3& view_from_scan, const LookTolerances& tolerances);

/// What a scan knows of space: asked place by place when a pose is judged.
class SpaceView {
 public:
  SpaceView() = default;
  SpaceView(const SpaceView&) = delete;
  SpaceView& operator=(const SpaceView&) = delete;
  virtual ~SpaceView() = default;

  [[nodiscard]] virtual Sight look(const SightQuery& query) const = 0;
  /// Looks at the pieces [begin, begin + size) of another scan's surface, at most kLookBatch, where
  /// `view_from_scan` lays them: what the answers need is fetched from memory ahead, for most of a look is
  /// waiting for it.
  virtual void look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                               const Rigid3& view_from_scan, const LookTolerances& tolerances,
                               Looks& looks) const;
};

/// A plane as a view of space needs it.
struct Facet {
  Plane plane;
  bool oriented = false;
};
std::vector<Facet> facets_of(const Features& features);
/// Signed distance to `facet` where it is the surface asked for: near enough, and facing the same way.
inline std::optional<double> distance_if_same(const SightQuery& query, const Facet& facet) {
  constexpr double kSameNormal = 0.94;  // cosine: about 20 degrees
  const double distance = facet.plane.signed_distance(query.at);
  if (std::abs(distance) > query.surface_m) return std::nullopt;
  if (!query.of_clutter()) {
    const double cosine = query.normal.dot(facet.plane.normal);
    if ((query.oriented && facet.oriented ? cosine : std::abs(cosine)) < kSameNormal) return std::nullopt;
  }
  return distance;
}

}  // namespace limen
