// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/simulate/truth/truth.h"
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

/// The truth of a simulated case as JSON text, all digits of every double: scene, seed, `local_origin`, and
/// - `scans`: file, kind, points, `world_from_scan` (four rows of four);
/// - `pairs`: `target_from_source` for every ordered pair of scans, and, where it was counted, the surface
/// that
///   both saw, `shared_m2`;
/// - `planes`: id, normal (to the visible side), `offset` in the world and `local_offset` about local_origin
///   (exact), class, area, `inliers` per scan, and of a wall as built its `bulge`: at x it is off the
///   plane by height_m sin(pi a) sin(pi b), a = u . (x - origin) and b = v . (x - origin) kept within [0, 1];
/// - `openings`: kind, rooms, wall normal and thickness, width, height, corners `outer` and `inner` in the
///   world (lower left, lower right, upper right, upper left, seen from outside), `head` (rectangular,
///   segmental, semicircle, round) and, where it is not rectangular, the clear opening as it is built,
///   `outer_outline` and `inner_outline`, of which the corners are the bounding rectangle, and per scan the
///   rays that crossed it, that came back from beyond, from its parts, and the share of its area seen
///   through.
/// - `model`, where one was scanned: file, `as_built`, number of pieces of `furniture` it does not have, the
///   room of each scan with its sizes and the spaces `like` it (`repeated`), and `changes`: element, guid,
///   kind, state (moved, missing, open), `shift_m`. World coordinates are the model's, and each scan has
///   `target_from_source`, its pose in the model.
/// The scans' files are named after them with ".ply".
std::string truth_json(const Truth& truth);

/// What a program under test may know of the case: files, what kind of scan each holds, which pair to join.
std::string task_json(const SimulatedCase& simulated);

}  // namespace limen
