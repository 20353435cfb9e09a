// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "limen/geometry/rigid.h"

namespace limen {

/// A place on the ellipsoid WGS84 (GRS80 differs from it by less than 0.1 mm).
struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;  ///< above the ellipsoid
};

/// A zone of the Universal Transverse Mercator grid.
struct UtmZone {
  int number = 0;  ///< 1 to 60
  bool south = false;
};

/// The zone a place lies in, the exceptions of Norway and Svalbard left aside.
UtmZone utm_zone_of(const Geodetic& place);
/// "32N", "32" (north) or "19S"; empty for anything else.
std::optional<UtmZone> parse_utm_zone(const std::string& text);

/// Easting, northing, height of a place, and where grid north points there.
struct GridPlace {
  Vector3d x = Vector3d::Zero();  ///< metres
  double convergence_rad = 0.0;   ///< of grid north from true north, clockwise
};
/// L. Krueger's series to the sixth order in the third flattening, as given by C. Karney, "Transverse
/// Mercator with an accuracy of a few nanometers", J. Geodesy 2011, eqs. (7)-(9), (24)-(35); below 1 mm where
/// the place is within 3000 km of the zone's meridian.
GridPlace to_utm(const Geodetic& place, const UtmZone& zone);

/// Earth-centred coordinates, metres.
Vector3d to_geocentric(const Geodetic& place);
/// East, north and up at a place, as rows: local_from_geocentric.
Matrix3d east_north_up(const Geodetic& place);

}  // namespace limen
