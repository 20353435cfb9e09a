// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/project/result/project_result.h"

namespace limen {

/// How a report looks at a project: rows to the right of the plan, upwards in the plan, and towards the
/// zenith, in the project's frame; along the building's walls, turned from the frame by 45 degrees at most.
Matrix3d project_axes(const ProjectResult& result);

/// The file's name without its folders, and the scan's number where the file has several: " #0" is the first.
std::string shown_name(const ProjectScan& scan);

/// A scan of the project's component as a plan shows it.
struct PlanSpot {
  std::size_t scan = 0;
  Vector3d at = Vector3d::Zero();  ///< its first station, the report's axes
};

/// The storeys that scans stand on, the lowest first, as far as they lie apart.
std::vector<std::vector<PlanSpot>> project_floors(const ProjectResult& result, const Matrix3d& axes);

}  // namespace limen
