// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace limen {

/// The value that would stand at `rank`, below their number, were they sorted. Reorders them.
template <typename Value>
Value ranked(std::vector<Value>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle one of some values, of an even number the larger of two. Reorders them.
template <typename Value>
Value median(std::vector<Value>& values) {
  return ranked(values, values.size() / 2);
}

}  // namespace limen
