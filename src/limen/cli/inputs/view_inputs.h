// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/geometry/spline_motion.h"
#include "limen/report/view/view_page.h"

namespace limen {

/// One scan or model to look at, and where it is.
struct ViewInput {
  std::string path;
  int scan = -1;               ///< of the file, those without points not counted; -1: all
  Rigid3 frame_from_world;     ///< metres
  std::string sha256;          ///< that its bytes must have; empty: any
  std::string stated_by = {};  ///< the file that says so
  /// Of a mobile pass that drifted: by how much each point moves within the frame, by its time.
  std::shared_ptr<const SplineMotion> bend = {};
};

/// What the words on the command line mean: scans and models as they lie, both sides of a result.json under
/// pose number `alternative`, all placed scans of a project.json. Notes what has no place. Throws Error for
/// JSON that is neither.
std::vector<ViewInput> view_inputs(const std::vector<std::string>& files, int alternative,
                                   const Session& session);

/// Reads them all, thinned to `most_points` together: small clouds whole, the rest in equal parts.
/// `metres_per_unit`: where the user says so. Throws Error where one cannot be read or is not the file that a
/// result is about.
ViewScene read_view(const std::vector<ViewInput>& inputs, std::size_t most_points,
                    std::optional<double> metres_per_unit, const Session& session);

}  // namespace limen
