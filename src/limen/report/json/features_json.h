// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/model/features.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The text of a segments file: `segments`, of each its ends `a` and `b`, three numbers each in the file's
/// own (world) coordinates, metres; `input` and `version` beside it.
std::string segments_json(const Features& features, const InputSummary& input);

/// The text of a features file. Coordinates are the scan file's own (world): of every plane `normal`,
/// `offset` (normal . x = offset, metres), `outline` (of the largest part: the outer ring, then the holes,
/// each a list of 3-D points, the first not repeated), `parts` (the outlines of the other parts), `inliers`,
/// `rms_m`, `area_m2`, `oriented` (the normal points to where it was seen from).
/// A plane's offset is good to 1e-8 m at coordinates of 6.8e6 m.
std::string features_json(const Features& features, const InputSummary& input);

/// The same with `openings`, of every opening: `corners` (four 3-D points, from lower left as seen from the
/// scanner's side: lower left, lower right, upper right, upper left), `facade` (index into `planes`),
/// `evidence` (rays that came back from behind the wall), `view` (through, recess or hole), `edge_sigma_m`
/// (of the bottom, right, top and left side; 1 or more: not seen), `reveal_depth_m`, `reveal_sigma_m`,
/// `reveal_complete` (the depth is the wall's thickness, not a lower bound), `outline` (3-D points where it
/// is not a rectangle, else empty).
std::string openings_json(const Features& features, const InputSummary& input);

}  // namespace limen
