// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "limen/io/table/cloud_writer.h"
#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"
#include "limen/model/scan.h"

namespace limen {

/// Writes a scan as binary little-endian PLY with all that is known of it: x y z as double in world
/// coordinates (the local origin added), per-point scanner positions as x_origin y_origin z_origin, GPS_time,
/// scan_line and scan_index, intensity, red green blue. A single scanner position, or that it is unknown,
/// goes into a comment "scanner_position" that read_ply understands. The file appears whole or not at all;
/// throws Error where it cannot be written.
void write_ply(const std::filesystem::path& path, const Scan& scan);

/// Writes binary little-endian PLY with every column of the plan in its own type; whole numbers of 64 bits
/// are named int64 and uint64, which few other programs know. The scanner position goes into a comment
/// "scanner_position" that read_ply understands, texts of the coordinate system into comments "crs".
/// Throws Error where the file cannot be written.
std::unique_ptr<CloudWriter> make_ply_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// The part of transform_cloud for PLY files.
TransformedCloud transform_ply(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output, const ReadOptions& options);

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
