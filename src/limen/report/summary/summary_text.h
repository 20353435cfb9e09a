// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/summary/registration_report.h"

namespace limen {

/// What the program tells a reader of a registration: the verdict, the pose as a shift of the source's middle
/// and a turn about it, how well it is known, the other poses, and what to do next. Plain ASCII but for what
/// the inputs bring; lines of a name and a value. `folder`: where the results are.
std::string summary_text(const RegistrationReport& report, const std::string& folder);

}  // namespace limen
