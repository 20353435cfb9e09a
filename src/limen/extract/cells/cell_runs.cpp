// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_runs.h"

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
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < codes_.size(); ++i) blocks += i == 0 || codes_[i] >> 3U != codes_[i - 1] >> 3U;
  table_.assign(std::bit_ceil(2 * blocks + 1), {});
  mask_ = table_.size() - 1;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    const std::uint64_t code = codes_[i] >> 3U;
    std::uint64_t slot = slot_of(code);
    while (table_[slot].first >= 0 && table_[slot].code != code) slot = (slot + 1) & mask_;
    Block& block = table_[slot];
    if (block.first < 0) block = {code, static_cast<std::int32_t>(i), 0};
    block.mask |= 1U << (codes_[i] & 7U);
  }
}

std::uint64_t CellRuns::slot_of(std::uint64_t block_code) const {
  return mix64(block_code) & mask_;
}

const CellRuns::Block* CellRuns::find(std::uint64_t block_code) const {
  for (std::uint64_t slot = slot_of(block_code); table_[slot].first >= 0; slot = (slot + 1) & mask_) {
    if (table_[slot].code == block_code) return &table_[slot];
  }
  return nullptr;
}

CellNeighbours CellRuns::neighbours(std::size_t i) const {
  const CellIndex at = morton_decode(codes_[i]);
  // Along each axis the cubes around lie in two blocks: bit k of `side` chooses the one of axis k. Unsigned
  // wrap-around gives a code that no block has.
  const auto block_of = [](std::uint32_t x, bool upper) { return (upper ? x + 1 : x - 1) >> 1U; };
  std::array<const Block*, 8> blocks{};
  for (std::uint32_t side = 0; side < 8; ++side) {
    blocks[side] = find(morton_encode(block_of(at.x, (side & 1U) != 0), block_of(at.y, (side & 2U) != 0),
                                      block_of(at.z, (side & 4U) != 0)));
  }
  CellNeighbours found;
  for (std::uint32_t step = 0; step < 27; ++step) {
    if (step == 13) continue;
    const std::uint32_t x = at.x + step % 3 - 1;
    const std::uint32_t y = at.y + step / 3 % 3 - 1;
    const std::uint32_t z = at.z + step / 9 - 1;
    const auto upper = [](std::uint32_t to, std::uint32_t from) {
      return to >> 1U == (from + 1) >> 1U ? 1U : 0U;
    };
    const Block* const block = blocks[upper(x, at.x) | upper(y, at.y) << 1U | upper(z, at.z) << 2U];
    const std::uint32_t child = (x & 1U) | (y & 1U) << 1U | (z & 1U) << 2U;
    if (block == nullptr || (block->mask >> child & 1U) == 0) continue;
    found.add(block->first + std::popcount(block->mask & ((1U << child) - 1U)));
  }
  return found;
}

}  // namespace limen
