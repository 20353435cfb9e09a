// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/register/prepare/prepared_pair.h"

namespace limen {

/// Which of two sides is worked on as the source, whichever a user calls so: the same for both orders, so
/// that swapping the sides turns an answer round and changes nothing else. A model is the target, a scan
/// taken along a path is where the other is not, and else the side of which more surface was seen. What tells
/// two sides apart in the end is their samples, one by one; sides that are the same have no order.
bool is_work_order(const PreparedScan& source, const PreparedScan& target);

/// The sides of a pair in the order in which they are worked on, and whether that is not the order in which
/// they were given.
struct WorkedPair {
  const PreparedScan& source;
  const PreparedScan& target;
  bool turned = false;

  [[nodiscard]] bool has_model() const { return source.model || target.model; }
};

/// `pair` has to outlive it.
WorkedPair worked_pair(const PreparedPair& pair);

}  // namespace limen
