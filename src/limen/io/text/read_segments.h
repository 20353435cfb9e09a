// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/model/segment_set.h"

namespace limen {

/// Whether the file's content is a set of segments in a form that read_segments() knows. False for everything
/// else, also for files that cannot be opened.
bool is_segment_file(const std::filesystem::path& path);

/// Reads 3-D segments, chosen by content:
/// - JSON of `limen segments`: `segments`, a list of objects with `a` and `b`, each three numbers, metres;
/// - JSON of `limen openings`: the seen sides of each of `openings`;
/// - text with the lines `p` (plane of a wall), `O` (opening) and `L x y z x y z ...` (segment): what the
///   authors of the 2022 paper publish; only `L` counts;
/// - text with a line for each 3-D line: a count, six coordinates for each of its collinear pieces, then the
///   image lines it was made from (their count, six numbers each): 3-D lines from photographs.
/// The local origin is a whole number of metres near the segments. Segments of no length are left out.
/// Throws Error with file and line where something is missing, no number or not finite, and where no segment
/// is left.
SegmentSet read_segments(const std::filesystem::path& path);

}  // namespace limen
