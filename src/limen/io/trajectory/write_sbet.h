// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/geometry/spline_motion.h"
#include "limen/io/crs/coordinate_system.h"

namespace limen {

/// One record of an SBET: time (s), latitude, longitude (rad), height (m), three speeds (m/s), roll, pitch,
/// heading of the platform, wander angle (rad), three accelerations, three rates.
using SbetRecord = std::array<double, 17>;

/// All records of a file. Throws Error where it is no SBET.
std::vector<SbetRecord> read_sbet_records(const std::filesystem::path& path);

/// Their bytes.
std::string sbet_bytes(const std::vector<SbetRecord>& records);

/// How a pass is moved: from the map of its trajectory into the frame, and there by the correction of its
/// time.
struct SbetMotion {
  Rigid3 frame_from_map;
  const SplineMotion* bend = nullptr;  ///< none: it stays rigid
};

/// Records moved: places and attitudes are corrected, speeds and accelerations, which are along the
/// platform's own axes or describe its motion, stay as they were. `source` is the map of the trajectory
/// before, `target` that of the frame.
std::vector<SbetRecord> moved_records(const std::vector<SbetRecord>& records, const MapProjection& source,
                                      const MapProjection& target, const SbetMotion& motion);

/// Where a scanner was.
struct TimedPlace {
  double time_s = 0.0;
  Vector3d x = Vector3d::Zero();  ///< on the map
};

/// Records of places alone: the heading is that of the way, roll and pitch are 0.
std::vector<SbetRecord> records_of_places(const std::vector<TimedPlace>& places, const MapProjection& map);

}  // namespace limen
