// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limen/register/judge/start_prior.h"

namespace limen {

/// What --start and --start-sigma say: "identity" or the name of a file with a pose (read_pose_file()), and
/// "2m,5deg": one standard deviation of the place (mm, cm, m, km) and of the turn (deg, rad). Nothing where
/// `pose` is empty. `points`: what --start-points says instead, as shown_point() reads it. `unit_of_text`:
/// the unit of a pose that is a text, metres. Throws Error that names the option.
std::optional<StartPrior> start_of(
    const std::string& pose, const std::string& sigma, const std::vector<std::string>& points = {},
    const std::function<double()>& unit_of_text = [] { return 1.0; });

/// "0.5m": a length with its unit (mm, cm, m, km), in metres. Throws Error that names the option.
double length_of(const std::string& text, const std::string& option);

}  // namespace limen
