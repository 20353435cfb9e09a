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

/// A coordinate system, as far as it is known. Where PROJ is there when the program runs, everything is known
/// of every system; without it what the text itself says.
struct CoordinateSystem {
  std::string stated;  ///< as it was given: "EPSG:2154", WKT or PROJJSON
  std::string name;    ///< "RGF93 v1 / Lambert-93"; empty: not known
  std::string code;    ///< "EPSG:2154"; empty: not known
  std::string wkt;  ///< well-known text, version 1 where the system can be expressed in it; empty: not known

  [[nodiscard]] bool known() const { return !stated.empty(); }
};

/// Understands EPSG:NUMBER, well-known text of either version, and PROJJSON. `where` is in messages.
/// Throws Error for what is none, for systems whose axes are no metres on a plane, and for those that only
/// PROJ knows where that is missing.
CoordinateSystem coordinate_system(const std::string& text, const std::string& where);

/// The same of a text that a file carries: what cannot be understood is kept as it was stated, never an
/// Error.
CoordinateSystem stated_system(const std::string& text);

/// Whether both are the same on the ground; heights are not compared. What is not known of either is no
/// difference.
bool same_system(const CoordinateSystem& a, const CoordinateSystem& b);

/// "RGF93 v1 / Lambert-93 (EPSG:2154)", or the first words of what was stated.
std::string words_of(const CoordinateSystem& system);

}  // namespace limen
