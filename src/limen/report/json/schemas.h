// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schemas (draft 2020-12) of what features_json, openings_json and segments_json write.
std::string planes_schema();
std::string openings_schema();
std::string segments_schema();

/// JSON Schema (draft 2020-12) of what limen evaluate --json prints.
std::string evaluation_schema();

/// The same of what it prints of a project.
std::string project_evaluation_schema();

/// JSON Schema (draft 2020-12) of result.json, as text. What it names is the contract with programs that read
/// the file: fields are added, never changed or taken away.
std::string result_schema();

}  // namespace limen
