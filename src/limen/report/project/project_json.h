// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/project/project_result.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// The text of project.json: the same bytes for the same files and options, whatever their order, the number
/// of threads, and what was kept from earlier runs.
std::string project_json(const ProjectResult& result, const OptionList& options);

}  // namespace limen
