// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/json/result_json.h"

namespace limen {

// Tables of the report page, ready HTML; an empty text where there is nothing to tell.

/// The few numbers that fit on the printed sheet.
std::string key_table(const RegistrationReport& report);
std::string sigma_table(const RegistrationReport& report);
std::string alternatives_table(const RegistrationReport& report);
std::string planes_table(const RegistrationReport& report);
std::string openings_table(const RegistrationReport& report);
std::string thickness_table(const RegistrationReport& report);
std::string inputs_table(const RegistrationReport& report);
std::string stages_table(const RegistrationReport& report);
std::string options_table(const RegistrationReport& report);

}  // namespace limen
