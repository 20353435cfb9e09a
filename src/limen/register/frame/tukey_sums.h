// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"

namespace limen {

/// Points by coordinate: many are looked at at once.
struct PointColumns {
  std::vector<double> x, y, z;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  void add(double px, double py, double pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
};

/// Those within `within_m` of a plane, in their order.
PointColumns near_plane(const PointColumns& points, const Plane& plane, double within_m);

/// Of points `begin` to `end` the number of the plane that is nearest, where one is nearer than `within_m`;
/// the first of equals. Any other label stays.
void label_nearest(const std::vector<Vector3d>& points, std::size_t begin, std::size_t end,
                   const std::vector<Plane>& planes, double within_m, std::vector<std::int32_t>& labels);

/// Sums of w, wx, wy, wz, wxx, wxy, wxz, wyy, wyz, wzz with Tukey's weight w of the distance from a plane
/// over `width_m`.
std::array<double, 10> tukey_sums(const PointColumns& points, const Plane& plane, double width_m);

}  // namespace limen
