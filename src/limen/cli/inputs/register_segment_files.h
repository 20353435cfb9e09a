// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/cli/terminal/command.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// Whether both files hold segments. Throws Error where only one does: a scan and a list of segments share
/// nothing that could be matched.
bool are_segment_files(const std::string& source, const std::string& target);

/// Reads both and registers them; everything of the report but `options`.
RegistrationReport register_segment_files(const std::string& source, const std::string& target,
                                          Gravity gravity, const Session& session);

}  // namespace limen
