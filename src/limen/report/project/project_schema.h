// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schema (draft 2020-12) of what project_json writes.
std::string project_schema();

}  // namespace limen
