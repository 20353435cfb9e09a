// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// Writes binary little-endian PLY with every column of the plan in its own type; whole numbers of 64 bits
/// are named int64 and uint64, which few other programs know. The optical centre goes into a comment
/// "scanner_position" that read_ply understands, texts of the coordinate system into comments "crs".
/// Throws Error where the file cannot be written.
std::unique_ptr<CloudWriter> make_ply_writer(const std::filesystem::path& path, const CloudPlan& plan);

}  // namespace limen
