// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// Moves a point file by `target_from_source`; the ending of `output` tells its format.
///
/// Where that is the format of the input, all of the file is kept but what has to move:
///  - PLY: encoding, comments, other elements, every value; moved coordinates become double, a comment with
///  an
///    offset is taken out, since it is added;
///  - LAS, LAZ: written as LAS or LAZ of the same version and point format with all its records;
///  - E57: only the poses of the scans differ;
///  - PTX: matrix and scanner lines are replaced, the points stay in the scanner's frame;
///  - PCD: x y z become double, the view point moves, all fields are kept; compressed points become plain
///  ones;
///  - PTS, XYZ and other text: the numbers of x y z (origins, normals) in each line are replaced.
/// To .ply, .las, .laz, .e57 and text (.xyz, .txt, .asc, .csv) from any other format every column goes with
/// its type; points stream. `system`: of the target's coordinates; LAS, LAZ and E57 tell it, and what is
/// joined as PLY or text in a comment. Not known: what the source says stays. The file appears whole or not
/// at all; throws Error for what cannot be read or written.
TransformedCloud transform_cloud(const std::filesystem::path& input, const Rigid3& target_from_source,
                                 const std::filesystem::path& output, const ReadOptions& options = {},
                                 Monitor& monitor = silent_monitor(), const CoordinateSystem& system = {});

/// A file and how it comes into the frame of the output.
struct CloudToMove {
  std::filesystem::path path;
  Rigid3 target_from_source;
};
/// Moves a cloud, and writes it and `others`, which lie in the target's frame already, to one .ply, .las,
/// .laz or .e57 with the columns of all; `source_cloud` tells which file a point is from, 0 being the moved
/// one. Without others it is transform_cloud.
TransformedCloud merge_clouds(const CloudToMove& moved, const std::vector<std::string>& others,
                              const std::filesystem::path& output, Monitor& monitor = silent_monitor(),
                              const CoordinateSystem& system = {});

/// One cloud of a file and how it comes into the frame of the output.
struct StationToMove {
  std::filesystem::path path;
  std::size_t cloud = 0;  ///< of the file, those without points not counted
  Rigid3 target_from_source;
  std::shared_ptr<const SplineMotion> bend = {};  ///< of a pass that drifted: by time, in the target's frame
};
/// Clouds of one file or several, each moved by a pose of its own, in one file. In an .e57 each stays a scan
/// of its own, its pose at the scanner position where that is known; in a .ply, .las or .laz they become one
/// cloud with the columns of all, and `source_cloud` tells which station a point is from where there are
/// several. Throws Error where a file has no such cloud, or more than 256 would become one.
TransformedCloud move_stations(const std::vector<StationToMove>& stations,
                               const std::filesystem::path& output, Monitor& monitor = silent_monitor(),
                               const CoordinateSystem& system = {});

/// The scan in the target frame, about a local origin near its points there.
Scan transformed(const Scan& scan, const Rigid3& target_from_source);

}  // namespace limen
