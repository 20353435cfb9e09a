// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/project/result/project_result.h"
#include "limen/report/sheet/sheet.h"

namespace limen {

/// A row for each scan, the worst first, in metres and degrees.
Sheet stations_sheet(const ProjectResult& result);
/// A row for each link, the worst first.
Sheet links_sheet(const ProjectResult& result);
/// The distances between planes of all links after the adjustment, and the worst link.
Sheet bundle_sheet(const ProjectResult& result);
/// A row for each loop of links.
Sheet loops_sheet(const ProjectResult& result);
/// A row for each surveyed point and target.
Sheet points_sheet(const ProjectResult& result);

}  // namespace limen
