// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/report/json/result_json.h"

namespace limen {

/// The verdict as a surveyor would say it. Plain text, not yet escaped.
struct VerdictWords {
  std::string headline;                ///< "Registered: the two scans fit in one way only"
  std::vector<std::string> sentences;  ///< what to expect, what is open
  std::string reason;                  ///< in the program's own words, where no sentence tells it
  std::string symbol;                  ///< one character: no outcome is told by colour alone
};
VerdictWords verdict_words(const RegistrationReport& report);

/// The last part of the input's path.
std::string file_name(const InputSummary& input);

/// "0.3 mm", "12 mm", "1.25 m"
std::string length_words(double metres);
/// "0.0021°"
std::string angle_words(double radians);

/// Whether the data leaves the shift along, or the turn about, an axis of the target's frame (0, 1, 2) open.
bool is_open(const RegistrationResult& result, bool rotation, int axis);

}  // namespace limen
