// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cell_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limen/base/random.h"

namespace limen {

int level_of(double cell_m, double finest_m) {
  return std::max(0, static_cast<int>(std::lround(std::log2(cell_m / finest_m))));
}

CellRuns::CellRuns(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level) {
  const int shift = 3 * level;
  for (std::uint32_t k = 0; k < active.size(); ++k) add(sorted.codes[active[k]] >> shift, k);
  finish(static_cast<std::uint32_t>(active.size()));
}

CellRuns::CellRuns(const MortonOrder& sorted, int level) {
  const int shift = 3 * level;
  const auto size = static_cast<std::uint32_t>(sorted.codes.size());
  for (std::uint32_t k = 0; k < size; ++k) add(sorted.codes[k] >> shift, k);
  finish(size);
}

void CellRuns::add(std::uint64_t code, std::uint32_t place) {
  if (!codes_.empty() && codes_.back() == code) return;
  codes_.push_back(code);
  begins_.push_back(place);
}

void CellRuns::finish(std::uint32_t places) {
  begins_.push_back(places);
  table_.assign(std::bit_ceil(2 * codes_.size() + 1), -1);
  mask_ = table_.size() - 1;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    std::uint64_t slot = mix64(codes_[i]) & mask_;
    while (table_[slot] >= 0) slot = (slot + 1) & mask_;
    table_[slot] = static_cast<std::int32_t>(i);
  }
}

std::int32_t CellRuns::find(std::uint64_t code) const {
  for (std::uint64_t slot = mix64(code) & mask_; table_[slot] >= 0; slot = (slot + 1) & mask_) {
    if (codes_[static_cast<std::size_t>(table_[slot])] == code) return table_[slot];
  }
  return -1;
}

CellNeighbours CellRuns::neighbours(std::size_t i) const {
  const CellIndex at = morton_decode(codes_[i]);
  CellNeighbours found;
  for (std::uint32_t step = 0; step < 27; ++step) {
    if (step == 13) continue;
    // Unsigned wrap-around gives a code that no cell has.
    const std::int32_t neighbour =
        find(morton_encode(at.x + step % 3 - 1, at.y + step / 3 % 3 - 1, at.z + step / 9 - 1));
    if (neighbour >= 0) found.add(neighbour);
  }
  return found;
}

}  // namespace limen
