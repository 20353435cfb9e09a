// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "limen/sight/surface_columns.h"

namespace limen {

/// In one line of the cache: most of a look is waiting for it.
struct alignas(16) PanoramaPixel {
  float near_m = 0.0F;  ///< closest return; 0: none
  float far_m = 0.0F;
  float clear_m = 0.0F;          ///< closest return of the 3 x 3 pixels around: rays passed freely up to here
  std::int16_t near_plane = -1;  ///< -1: clutter, and what lies on a plane whose number is too large
  std::int16_t far_plane = -1;
};

/// A plane seen from the panorama's centre.
struct PanoramaFacet {
  std::array<float, 3> normal{};
  float distance_m = 0.0F;  ///< of the plane from the centre, along the normal
  float oriented = 0.0F;    ///< 1 where the sign of the normal counts
};

/// A panorama and a pose, as a look at many pieces of surface takes them.
struct PanoramaLook {
  const PanoramaPixel* pixels = nullptr;
  const PanoramaFacet* facets = nullptr;
  std::int32_t edge = 0;            ///< pixels per cube edge
  std::array<float, 9> rotation{};  ///< by rows, from the scan of the pieces
  std::array<float, 3> shift{};     ///< of that scan's local origin from the panorama's centre
  float surface_m = 0.0F;
  float clutter_m = 0.0F;
  float free_m = 0.0F;
};

/// Looks at the pieces [begin, begin + size) of `asked`, at most kLookBatch. Says what Panorama::look() says,
/// in single precision; the same on every processor, as wide as it may calculate.
void look_at_surface(const PanoramaLook& look, const SurfaceColumns& asked, std::size_t begin,
                     std::size_t size, Looks& looks);

}  // namespace limen
