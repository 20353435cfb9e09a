// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/result/project_result.h"

namespace limen {

/// How the mobile passes drifted: for each that was bent a drawing (SVG) of its correction along the way,
/// with two standard deviations; for others why they were not. Empty where there are no passes.
std::string pass_charts(const ProjectResult& result);

}  // namespace limen
