// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// The writer for the ending of the file: .ply, .las, .laz, .e57, or text (.xyz, .txt, .asc,
/// .csv). Throws Error for any other.
std::unique_ptr<CloudWriter> make_cloud_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// Whether make_cloud_writer knows the ending.
bool is_cloud_ending(const std::filesystem::path& path);

/// Whether a name ends as that of any file of points does.
bool has_cloud_ending(const std::filesystem::path& path);

}  // namespace limen
