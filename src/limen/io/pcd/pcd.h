// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// The part of transform_cloud for PCD files.
TransformedCloud transform_pcd(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output);

/// True where the bytes begin like a PCD file.
bool looks_like_pcd(std::string_view bytes);

/// Reads a PCD file (version 0.5 to 0.7) from memory: ascii, binary and binary_compressed, fields of any type
/// and count, rows and columns, packed rgb. A VIEWPOINT whose translation is not zero counts as scanner
/// position where it can be one; the points are taken as they are. `name` is for messages.
/// Throws Error that names the file and the line or byte.
ScanFile read_pcd(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// The same file as a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_pcd(std::string_view bytes, const std::string& name);

}  // namespace limen
