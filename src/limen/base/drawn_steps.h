// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "limen/base/random.h"

namespace limen {

/// Calls `use` with at most `most` of the numbers 0 to size - 1, ascending: one of each run of as many as
/// follow one another, drawn at random. Every so many-th itself would be of one scan line where its length
/// divides.
template <typename Use>
void for_drawn_steps(std::size_t size, std::size_t most, const Use& use) {
  const std::size_t step = std::max<std::size_t>(1, (size + most - 1) / std::max<std::size_t>(1, most));
  for (std::size_t begin = 0; begin < size; begin += step)
    use(begin + (step == 1 ? 0 : mix64(begin) % std::min(step, size - begin)));
}

}  // namespace limen
