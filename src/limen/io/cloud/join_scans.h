// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/scan.h"

namespace limen {

/// One scan of several in the same world frame, about the local origin of the first, each point with its own
/// optical centre. Centres, times, intensities, colours and topology are kept where every scan has them.
/// `scans` is not empty.
Scan join_scans(const std::vector<Scan>& scans);

}  // namespace limen
