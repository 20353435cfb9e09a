// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limen {

/// JSON Schema (draft 2020-12) of what limen evaluate --json prints.
std::string evaluation_schema();

/// The same of what it prints of a project.
std::string project_evaluation_schema();

}  // namespace limen
