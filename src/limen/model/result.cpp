// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/result.h"

#include "limen/base/named.h"

namespace limen {

const char* to_string(Outcome outcome) {
  static constexpr Named<Outcome> names[] = {{Outcome::registered, "registered"},
                                             {Outcome::probable, "probable"},
                                             {Outcome::ambiguous, "ambiguous"},
                                             {Outcome::under_constrained, "under_constrained"},
                                             {Outcome::no_match, "no_match"}};
  return name_of(names, outcome);
}

}  // namespace limen
