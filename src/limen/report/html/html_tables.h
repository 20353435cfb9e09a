// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/json/result_json.h"

namespace limen {

// Tables of the report page, ready HTML; an empty text where there is nothing to show.

/// The few numbers that fit on the printed sheet. `pose`: 0 is the best one, then come the alternatives.
std::string key_table(const RegistrationReport& report, std::size_t pose = 0);
/// Shift of the source's middle, turn about it, and how well each is held, of a pose as above.
std::string sigma_table(const RegistrationReport& report, std::size_t pose = 0);
/// Why there was no match, the likeliest first, with what was measured.
std::string causes_table(const RegistrationReport& report);
std::string alternatives_table(const RegistrationReport& report);
std::string planes_table(const RegistrationReport& report);
std::string openings_table(const RegistrationReport& report);
std::string thickness_table(const RegistrationReport& report);
std::string inputs_table(const RegistrationReport& report);
std::string stages_table(const RegistrationReport& report);
std::string options_table(const RegistrationReport& report);

}  // namespace limen
