// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// True where the bytes begin like a PLY file.
bool looks_like_ply(std::string_view bytes);

/// Reads a PLY file from memory: ascii, binary little- and big-endian, any number types, any other elements
/// and lists (passed over). Understood per point: x y z, x_origin y_origin z_origin, GPS_time, scan_line and
/// scan_index, theta, red green blue, intensity or reflectance. `name` is for messages.
/// Throws Error that names the file and the line or byte.
ScanFile read_ply(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// The same file as a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_ply(std::string_view bytes, const std::string& name);

}  // namespace limen
