// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/io/table/record_table.h"

namespace limen {

/// Whether a column of this name (lower case) holds red, green or blue.
bool is_colour(const std::string& name);

/// The largest number of the kind of colours of which the largest is `largest`: 1 for fractions, 255 or
/// 65535. `integer`: the numbers are whole.
double colour_top(double largest, bool integer);

/// The largest finite number of a column, 0 where none is greater. Several threads.
double largest_value(const RecordTable& table, const Field& field);

}  // namespace limen
