// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/json/json_values.h"

namespace limen {

/// JSON Schema (draft 2020-12) of what deviation_json writes.
std::string deviation_schema();

/// The same of the deviation of a whole project.
std::string project_deviation_schema();

namespace schema {
Json deviation_element_schema();
Json element_shift_schema();
Json unmodelled_schema();
}  // namespace schema

}  // namespace limen
