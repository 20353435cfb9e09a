// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/register/prepare/prepare_scan.h"

namespace limen {

/// Two scans made ready with the same options, or one and a model, either way round.
struct PreparedPair {
  PreparedScan source;
  PreparedScan target;
};

}  // namespace limen
