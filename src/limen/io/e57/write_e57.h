// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// Writes one cloud as an E57 file of one scan. Points are stored about the scan's pose, a shift to the
/// optical centre where the plan has one, else to CloudPlan::near: as doubles, or as integers of an eighth of
/// CloudPlan::resolution_m. Standard columns (intensity, colour, time, row and column, normals) become what
/// other programs read; all others become columns of an extension, so that nothing is lost. Points whose
/// coordinates are not numbers are marked invalid.
/// Throws Error where the plan lacks x, y, z or the file cannot be written, in write() where a row does not
/// fit.
std::unique_ptr<CloudWriter> make_e57_writer(const std::filesystem::path& path, const CloudPlan& plan);

}  // namespace limen
