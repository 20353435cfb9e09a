// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/json/json_values.h"

namespace limen {

/// What `limen info` says of several files, a line for each scan and model: name, format, points (of a model:
/// elements), size in metres, place of the scanner, notes. `files`: what it says of each in JSON, or what
/// went wrong as `error`.
std::string info_table(const Json& files);

}  // namespace limen
