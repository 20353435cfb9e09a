// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/simulate/truth/truth.h"

namespace limen {

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
