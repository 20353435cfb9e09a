// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/io/read_scan.h"

namespace limen {

/// What became of a point file that was moved.
struct TransformedCloud {
  std::size_t points = 0;
  std::string format;              ///< of the input, in a user's words
  std::vector<std::string> notes;  ///< sentences about what was left out or could not be moved
};

/// Moves a point file by `target_from_source` and writes it as PLY.
///
/// A PLY keeps its encoding, its comments, its other elements and every value per point: only x y z,
/// x_origin y_origin z_origin and the scanner's position move, normals turn. Moved coordinates are written as
/// double in target coordinates, so that no digit is lost on a national grid; a comment with an offset is
/// taken out, since it is added. Other formats are written by write_ply; several scans become one.
/// The file appears whole or not at all; throws Error for what cannot be read or written.
TransformedCloud transform_cloud(const std::filesystem::path& input, const Rigid3& target_from_source,
                                 const std::filesystem::path& output, const ReadOptions& options = {},
                                 Monitor& monitor = silent_monitor());

/// The scan in the target frame, about a local origin near its points there.
Scan transformed(const Scan& scan, const Rigid3& target_from_source);

}  // namespace limen
