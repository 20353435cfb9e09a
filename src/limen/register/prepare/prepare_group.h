// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// Several scans known to one another, made ready as if they were one: planes, openings and samples of all,
/// surfaces seen from several stations once, and what all scanners know of space. The group's frame is that
/// of the first scan if its pose is the identity. Throws Error for an empty list.
PreparedScan prepare_group(const std::vector<PlacedScan>& scans, const PrepareOptions& options = {},
                           Monitor& monitor = silent_monitor());
/// The same of scans that are not needed any more: their memory is given back on the way.
PreparedScan prepare_group(std::vector<PlacedScan>&& scans, const PrepareOptions& options = {},
                           Monitor& monitor = silent_monitor());

}  // namespace limen
