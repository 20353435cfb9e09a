// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/result.h"

namespace limen {

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::registered:
      return "registered";
    case Outcome::ambiguous:
      return "ambiguous";
    case Outcome::under_constrained:
      return "under_constrained";
    case Outcome::no_match:
      return "no_match";
  }
  return "no_match";
}

}  // namespace limen
