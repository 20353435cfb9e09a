// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/model/result.h"
#include "limen/report/summary/registration_report.h"

namespace limen {

/// The places between which an ambiguous answer leaves the choice, beside the best pose.
struct AnswerPlaces {
  std::vector<std::size_t> alternatives;  ///< indices into the result's, in their order
  bool look_alike = false;                ///< one built alike that no listed pose is
};

/// The likeliest that together with the best pose reach 95 % of what is not that nothing is shared. All
/// alternatives where the result tells no probabilities.
AnswerPlaces answer_places(const RegistrationResult& result);

/// What the program tells a reader of a registration: the verdict, the pose as a shift of the source's middle
/// and a turn about it, how well it is known, the other poses, and what to do next. Plain ASCII but for what
/// the inputs bring; lines of a name and a value. `folder`: where the results are.
std::string summary_text(const RegistrationReport& report, const std::string& folder);

}  // namespace limen
