// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/model/scan.h"

namespace limen {

/// Writes a scan as binary little-endian PLY with all that is known of it: x y z as double in world
/// coordinates (the local origin added), per-point optical centres as x_origin y_origin z_origin, GPS_time,
/// scan_line and scan_index, intensity, red green blue. A single optical centre, or that it is unknown, goes
/// into a comment "scanner_position" that read_ply understands.
/// The file appears whole or not at all; throws Error where it cannot be written.
void write_ply(const std::filesystem::path& path, const Scan& scan);

}  // namespace limen
