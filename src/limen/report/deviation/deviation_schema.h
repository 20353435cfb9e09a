// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schema (draft 2020-12) of what deviation_json writes.
std::string deviation_schema();

}  // namespace limen
