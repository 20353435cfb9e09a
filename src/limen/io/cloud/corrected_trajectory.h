// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/io/cloud/transform_cloud.h"
#include "limen/io/trajectory/write_sbet.h"

namespace limen {

/// Where the scanner of a mobile pass was, moved as its points are, a place every 5 ms at most; none where
/// the points do not tell where they were seen from or when.
std::vector<TimedPlace> corrected_places(const StationToMove& pass, Monitor& monitor = silent_monitor());

/// Text with a header line, `time,x,y,z` in seconds and metres, that read_trajectory() reads.
std::string text_of_places(const std::vector<TimedPlace>& places);

}  // namespace limen
