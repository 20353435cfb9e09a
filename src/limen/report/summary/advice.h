// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/report/summary/registration_report.h"

namespace limen {

/// Why two sides may not have been brought together, and what was measured about it.
struct LikelyCause {
  std::string name;  ///< "overlap", "units", "axes", "place of the scanner", "another place", "another pair"
  std::string measured;  ///< what the data show
  std::string remedy;    ///< what to do about it
};

/// Of a registration without a match: the likeliest first. Empty for every other outcome.
std::vector<LikelyCause> likely_causes(const RegistrationReport& report);

/// What the user does next, sentences of plain text, for every outcome. `folder`: where result.json and
/// report.html are; it is part of the commands that are named.
std::vector<std::string> next_steps(const RegistrationReport& report, const std::string& folder = "");

/// Of a pose that is placed, but not surely: the one thing that would make it surer, after what else is the
/// likeliest.
std::string surer(const RegistrationReport& report);

/// "ft" where the numbers of one side would fit the other's if they were feet (in, mm, cm likewise).
struct UnitGuess {
  bool source = false;  ///< of the source's numbers, else of the target's
  std::string unit;     ///< as --source-units takes it
  double apart = 1.0;   ///< factor by which the heights still differ then
};
std::optional<UnitGuess> likely_unit(const InputSummary& source, const InputSummary& target);

}  // namespace limen
