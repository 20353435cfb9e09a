// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/report/summary/words.h"

namespace limen {

/// The verdict as a surveyor would say it. Plain text, not yet escaped.
struct VerdictWords {
  std::string headline;                ///< "Registered: the two scans fit in one way only"
  std::vector<std::string> sentences;  ///< what to expect, what is open
  std::string reason;                  ///< in the program's own words, where no sentence tells it
  std::string symbol;                  ///< one character: no outcome is shown by colour alone
};
VerdictWords verdict_words(const RegistrationReport& report);

}  // namespace limen
