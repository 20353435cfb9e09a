// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schema (draft 2020-12) of result.json, as text. What it names is the contract with programs that read
/// the file: fields are added, never changed or taken away.
std::string result_schema();

}  // namespace limen
