// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "limen/geometry/rigid.h"

namespace limen {

/// Geographic places of WGS 84 and their like in a map's system, by PROJ: any system that it knows. Heights
/// stay above the ellipsoid unless the system names others.
class MapProjection {
 public:
  /// `system`: EPSG:NUMBER, WKT or PROJJSON. Throws Error where PROJ is missing or does not know it.
  MapProjection(const std::string& system, const std::string& where);
  ~MapProjection();
  MapProjection(MapProjection&&) noexcept;
  MapProjection& operator=(MapProjection&&) noexcept;

  /// Easting, northing, height in metres of a latitude and a longitude in radians. Throws Error outside of
  /// what the projection can show.
  [[nodiscard]] Vector3d to_map(double latitude_rad, double longitude_rad, double height_m) const;
  /// Latitude, longitude (radians) and height of a place on the map.
  [[nodiscard]] Vector3d from_map(const Vector3d& x) const;
  /// The heading of grid north there, clockwise from true north, radians.
  [[nodiscard]] double convergence_rad(double latitude_rad, double longitude_rad, double height_m) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace limen
