// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/point_file.h"

namespace limen {

/// True where the bytes begin like an E57 file.
bool looks_like_e57(std::string_view bytes);

/// Opens an E57 file (ASTM E2807, version 1) in memory: one cloud per scan (Data3D), with its pose as
/// TableFacts::pose. Columns are named as scan_builder knows them: x y z (spherical ones become Cartesian),
/// intensity, red green blue, gps_time (start of the acquisition added), row_index, column_index, nx ny nz;
/// all others keep their names in lower case, those that limen wrote without their namespace. Rows that the
/// file marks invalid have coordinates that are not numbers. Images are passed over.
///
/// `bytes` must outlive what is returned; `name` is for messages. The check sums of all pages that are read
/// are verified. Throws Error that names the file, the place and what can be done, here for the head and the
/// description, in PointStream::next for the points.
std::unique_ptr<PointFile> open_e57(std::string_view bytes, const std::string& name);

/// The coordinate system that an E57 file names (usually WKT), or nothing. Throws Error as open_e57.
std::vector<std::string> e57_coordinate_systems(std::string_view bytes, const std::string& name);

}  // namespace limen
