// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "limen/sight/space_view.h"

namespace limen {

/// Asks `space` `count` questions in order: `question(k)` is the query of the k-th, and `use(k, query,
/// sight)` gets its answer. What a batch of them needs is fetched from memory while the batch is still being
/// put.
template <typename Question, typename Use>
void ask_in_batches(const SpaceView& space, std::size_t count, const Question& question, const Use& use) {
  constexpr std::size_t kBatch = 32;
  std::array<SightQuery, kBatch> queries;
  for (std::size_t begin = 0; begin < count; begin += kBatch) {
    const std::size_t size = std::min(kBatch, count - begin);
    for (std::size_t k = 0; k < size; ++k) queries[k] = question(begin + k);
    space.fetch({queries.data(), size});
    for (std::size_t k = 0; k < size; ++k) use(begin + k, queries[k], space.look(queries[k]));
  }
}

}  // namespace limen
