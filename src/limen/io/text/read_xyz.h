// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// True where the bytes are text whose first lines are rows of numbers (PTS, XYZ, CSV).
bool looks_like_xyz(std::string_view bytes);

/// Reads points from text: PTS with its count line, XYZ, CSV and the like from memory. Separators are blanks,
/// tabs, commas and semicolons; numbers have decimal points. Lines that begin with #, % or // are comments; a
/// line with names x, y and z, a comment or not, names the columns. Without names: 3 columns are x y z, 4 end
/// with intensity, 7 with intensity red green blue, 6 with red green blue where these are whole numbers up to
/// 255; further columns are passed over. `name` is for messages. Throws Error that names file and line.
ScanFile read_xyz(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

/// How the rows of a text are to be understood.
struct TextLayout {
  std::size_t body = 0;            ///< bytes before the first row
  bool counted = false;            ///< lines with a count stand before rows (PTS)
  std::vector<std::string> names;  ///< of the columns, lower case
};
TextLayout text_layout(std::string_view bytes, const std::string& name);

/// The same file as a cloud that is read in pieces; `bytes` must outlive it.
std::unique_ptr<PointFile> open_xyz(std::string_view bytes, const std::string& name);

}  // namespace limen
