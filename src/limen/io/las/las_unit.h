// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "limen/io/las/las_header.h"

namespace limen {

/// Metres per unit of x and y, as the file's coordinate system says: GeoTIFF keys (ProjLinearUnits of a
/// projected system, then its own size of a unit), or the last length unit of a WKT text's projected system.
/// Empty where it does not say, or the coordinates are degrees.
std::optional<double> las_metres_per_unit(const LasHeader& header);

/// The same of one WKT text (OGC 01-009 and ISO 19162): of its PROJCS, PROJCRS or LOCAL_CS, else empty.
std::optional<double> wkt_metres_per_unit(std::string_view wkt);

/// "EPSG:2154": the projected system that the GeoTIFF keys name by a number; empty where they do not.
std::string las_projected_code(const LasHeader& header);

/// The body of the record of GeoTIFF keys (number 34735) that names a projected system in metres by its EPSG
/// number, as "EPSG:2154".
std::string las_key_directory(const std::string& code);

}  // namespace limen
