// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/io/table/record_table.h"

namespace limen {

/// The column with the time of each point, in whatever way it is called; nullptr: there is none.
const Field* find_times(const RecordTable& table);

}  // namespace limen
