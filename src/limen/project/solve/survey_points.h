// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/project/solve/place_survey.h"

namespace limen {

/// The points as they are reported.
std::vector<ProjectPoint> stated_points(const Survey& survey, const PlacedSurvey& placed,
                                        const std::vector<ProjectNode>& nodes);

}  // namespace limen
