// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/register/judge/as_built.h"
#include "limen/register/judge/built_planes.h"

namespace limen {

/// Surfaces of the building that both scans saw under a pose, and how well they were measured.
struct CommonSurfaces {
  std::vector<CommonSurface> all;
  /// Scatter of a quarter of a metre of surface as one scan has it, standard deviation, by how the two differ
  /// after each surface's own offset and slopes; 0: hardly anything was seen by both.
  double scatter_m = 0.0;
};

/// Asks where tiles of both scans lie in one plane under poses (upright frames). Layers of one wall count
/// once: the one most of which was seen. The tiles of each wall are gathered once; what the views point to
/// has to outlive this.
class CommonSurfaceFinder {
 public:
  CommonSurfaceFinder(const ScanView& source, const BuiltPlanes& built_source, const ScanView& target,
                      const BuiltPlanes& built_target);
  ~CommonSurfaceFinder();
  CommonSurfaceFinder(const CommonSurfaceFinder&) = delete;
  CommonSurfaceFinder& operator=(const CommonSurfaceFinder&) = delete;

  [[nodiscard]] CommonSurfaces operator()(const Rigid3& target_from_source) const;

 private:
  struct Walls;
  std::unique_ptr<Walls> walls_;
};

}  // namespace limen
