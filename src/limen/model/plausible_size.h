// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

namespace limen {

/// Throws Error where points cannot be a scan of a building or a street in metres: nearly all of them
/// together are smaller than a hand, larger than a country, or as high and deep as they are wide over more
/// than a kilometre (a room in millimetres). Points far from the others, up to one in a hundred at either end
/// of an axis, do not count. Empty scans pass.
void require_plausible_size(const Scan& scan);

/// Throws Error where a model cannot be a building in metres: it is smaller than a chair, or has so much
/// surface that no computer of today could look at every hand's breadth of it.
void require_plausible_size(const BimModel& model);

}  // namespace limen
