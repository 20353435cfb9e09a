// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "limen/io/point_file.h"
#include "limen/io/read_scan.h"

namespace limen {

/// True where the bytes are text whose first lines are rows of numbers (PTS, XYZ, CSV).
bool looks_like_xyz(std::string_view bytes);

/// Reads points from text: PTS with its count line, XYZ, CSV and the like from memory. Separators are blanks,
/// tabs, commas and semicolons; numbers have decimal points. Lines that begin with #, % or // are comments; a
/// line with names x, y and z, a comment or not, names the columns. Without names: 3 columns are x y z, 4 end
/// with intensity, 7 with intensity red green blue, 6 with red green blue where these are whole numbers up to
/// 255; further columns are passed over. `name` is for messages. Throws Error that names file and line.
ScanFile read_xyz(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// The same file as a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_xyz(std::string_view bytes, const std::string& name);

}  // namespace limen
