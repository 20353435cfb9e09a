// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/model/features.h"

namespace limen {

/// Pieces of surface of one scan, column by column, as a view of space takes many at once. Single precision:
/// they lie about the scan's local origin, where its steps are a hundredth of a millimetre a hundred metres
/// away.
struct SurfaceColumns {
  std::vector<float> x, y, z;        // metres
  std::vector<float> nx, ny, nz;     // zero for clutter
  std::vector<float> oriented;       // 1 where the normal's sign counts, or 0
  std::vector<std::int32_t> planar;  // 0 for clutter

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vector3d place(std::size_t i) const { return {x[i], y[i], z[i]}; }
  [[nodiscard]] Vector3d normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
  void reserve(std::size_t count);
  void add(const SurfaceSample& sample, bool oriented_plane);
  /// The i-th sample of a scan.
  void add(const Features& scan, std::size_t i);
};

struct LookTolerances {
  double surface_m = 0.05;   ///< surfaces of planes nearer than this are the same
  double clutter_m = 0.075;  ///< and clutter
  double free_m = 0.10;      ///< surface is contradicted where rays passed this much beyond
};

/// Pieces of surface that are looked at together, at most.
constexpr std::size_t kLookBatch = 64;

/// What a view of space says to pieces of surface: for each a SightKind as a number, and for surface its
/// plane, or -1, and the signed distance to it.
struct Looks {
  std::array<std::int32_t, kLookBatch> kind;
  std::array<std::int32_t, kLookBatch> plane;
  std::array<float, kLookBatch> distance_m;
};

}  // namespace limen
