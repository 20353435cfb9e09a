// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/plane.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

/// What is the building's of one scan: its large planes as boxes in the planes' own coordinates, one for each
/// part, and what is near them. Upright frame.
class BuiltPlanes {
 public:
  explicit BuiltPlanes(const ScanView& view);

  [[nodiscard]] bool is_built(std::int32_t plane) const { return built_[static_cast<std::size_t>(plane)]; }

  [[nodiscard]] const std::vector<bool>& flags() const { return built_; }

  enum class Place { off, at_wall, behind };
  /// Where `x` is against the walls: at one (or at the ceiling), or behind one.
  [[nodiscard]] Place place(const Vector3d& x) const;

  /// Whether the way from `a` to `b` leads through a wall, or an opening of it.
  [[nodiscard]] bool between(const Vector3d& a, const Vector3d& b) const;

 private:
  struct Part {
    Plane plane;
    PlaneFrame frame;
    Box2 box;
    bool strip = false;

    /// Whether `x` is right below a ceiling.
    [[nodiscard]] bool is_above(const Vector3d& x) const;
  };

  void add(std::size_t i, const PlanarPolygon& plane, bool strip);
  static bool reaches_ceiling(const PlanarPolygon& plane, const std::vector<Part>& large);
  static bool continues_wall(const PlanarPolygon& plane, const std::vector<Part>& large);

  std::vector<bool> built_;
  std::vector<Part> parts_;
};

}  // namespace limen
