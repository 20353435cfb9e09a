// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/model/result.h"

namespace limen {

/// The places between which an ambiguous answer leaves the choice, beside the best pose.
struct AnswerPlaces {
  std::vector<std::size_t> alternatives;  ///< indices into the result's, in their order
  bool look_alike = false;                ///< one built alike that no listed pose is
};

/// The likeliest that together with the best pose reach 95 % of what is not that nothing is shared. All
/// alternatives where the result tells no probabilities.
AnswerPlaces answer_places(const RegistrationResult& result);

}  // namespace limen
