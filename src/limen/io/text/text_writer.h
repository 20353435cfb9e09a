// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// Writes text, one point a line: a first line with the names of the columns (after "//", or plain in .csv),
/// numbers with blanks between them (commas in .csv). Coordinates have six decimals, a micrometre; all other
/// numbers the digits that give their type back. Optical centre and coordinate system stand in comment lines,
/// not in .csv. Throws Error where the file cannot be written.
std::unique_ptr<CloudWriter> make_text_writer(const std::filesystem::path& path, const CloudPlan& plan);

}  // namespace limen
