// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/progress.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/read_scan.h"

namespace limen {

/// Reads every cloud of a file piece after piece, and makes a scan of each; clouds without points are named
/// in a note. Throws Error where none has points.
ScanFile read_clouds(const OpenPoints& input, const ReadOptions& options,
                     Monitor& monitor = silent_monitor());

/// Bytes that the scans of a file take in memory, about.
std::uint64_t scan_bytes(const OpenPoints& input);

/// The same for a file whose scans would take more than `options.memory_bytes`: each is thinned while it is
/// read, and a note tells to how many points and at what spacing. Thinned scans have no scan lines.
ScanFile read_thinned(const OpenPoints& input, const ReadOptions& options,
                      Monitor& monitor = silent_monitor());

/// The scanner position of a cloud, in the coordinates that read_scan gives its points, as read_scan would
/// settle it, judged by some of its points; empty where it is unknown or differs from point to point.
std::optional<Vector3d> settled_centre(const OpenPoints& input, std::size_t cloud,
                                       Monitor& monitor = silent_monitor());

}  // namespace limen
