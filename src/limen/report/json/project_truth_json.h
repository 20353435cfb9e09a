// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/simulate/whole/project_truth.h"

namespace limen {

/// The truth of a simulated project as JSON text, all digits of every double: building, seed, `as_built`
/// (where it is), `local_origin`, and
/// - `scans`: name, file, kind (station, mobile), points, `room` (index or null), `scanner` of a station in
/// its
///   own frame, drift_m, `drift` of a pass (rows of a time in seconds and the error x y z then, metres),
///   `surface_m2` it saw, `world_from_scan` (four rows of four);
/// - `shared`: pairs of scans `a` < `b` (indices into scans) and the surface `m2` that both saw;
/// - `rooms`: storey, unit (flat, house, bay; null: none), use, area_m2, `alike` (rooms of one number are
/// built
///   alike; null: like no other), mirrored, furnished_alike.
std::string project_truth_json(const ProjectTruth& truth);

/// What a program under test may know: the files, in their order, and what kind of scan each holds.
std::string project_task_json(const ProjectTruth& truth);

}  // namespace limen
