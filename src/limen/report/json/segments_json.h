// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/geometry/segment.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The text of a segments file: `segments`, of each its ends `a` and `b`, three numbers each in the file's
/// own (world) coordinates, metres; `input` and `version` beside it. `segments` are about `local_origin`.
std::string segments_json(const std::vector<Segment>& segments, const Vector3d& local_origin,
                          const InputSummary& input);

}  // namespace limen
