// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "limen/sight/space_view.h"

namespace limen {

/// Asks `space` `count` questions in order: `question(k)` is the query of the k-th, and `use(k, query,
/// sight)` gets its answer. They are put in batches: most of a look is waiting for memory.
template <typename Question, typename Use>
void ask_in_batches(const SpaceView& space, std::size_t count, const Question& question, const Use& use) {
  std::array<SightQuery, kSightBatch> queries;
  std::array<Sight, kSightBatch> sights;
  for (std::size_t begin = 0; begin < count; begin += kSightBatch) {
    const std::size_t size = std::min(kSightBatch, count - begin);
    for (std::size_t k = 0; k < size; ++k) queries[k] = question(begin + k);
    space.look_all({queries.data(), size}, {sights.data(), size});
    for (std::size_t k = 0; k < size; ++k) use(begin + k, queries[k], sights[k]);
  }
}

}  // namespace limen
