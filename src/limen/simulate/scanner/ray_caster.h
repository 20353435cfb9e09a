// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// Where a ray meets the mesh.
struct RayHit {
  int surface = -1;      ///< the side that was met; -1: nothing
  double range_m = 0.0;  ///< along the unit direction, computed in double precision on the surface's plane
  double cosine = 0.0;   ///< |direction . normal|
  bool inside = false;   ///< met from behind, which needs a crack between triangles

  [[nodiscard]] bool found() const { return surface >= 0; }
};

/// Closest hits of rays with a mesh. The mesh must outlive it. Safe to call from many threads.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// The first hit beyond `from_m` along the unit `direction`.
  [[nodiscard]] RayHit cast(const Vector3d& origin, const Vector3d& direction, double from_m = 0.0) const;
  [[nodiscard]] const Mesh& mesh() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace limen
