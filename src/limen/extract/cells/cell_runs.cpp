// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::uint32_t kBlockBits = 6;  // of a code: its place in a block of 4 x 4 x 4
constexpr std::uint64_t kInBlock = 63;

/// Bits of the curve's code of a step along each axis, of the place in a block.
std::uint32_t place_in_cells(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return (x & 1U) | (y & 1U) << 1U | (z & 1U) << 2U | (x & 2U) << 2U | (y & 2U) << 3U | (z & 2U) << 4U;
}

}  // namespace

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
  for (std::size_t i = 0; i < codes_.size(); ++i)
    blocks += i == 0 || codes_[i] >> kBlockBits != codes_[i - 1] >> kBlockBits;
  table_.assign(std::bit_ceil(2 * blocks + 1), {});
  mask_ = table_.size() - 1;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    const std::uint64_t code = codes_[i] >> kBlockBits;
    std::uint64_t slot = slot_of(code);
    while (table_[slot].first >= 0 && table_[slot].code != code) slot = (slot + 1) & mask_;
    Block& block = table_[slot];
    if (block.first < 0) block = {code, static_cast<std::int32_t>(i), 0};
    block.mask |= std::uint64_t{1} << (codes_[i] & kInBlock);
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
  // Along each axis the cubes around lie in one block or two: bit k of `side` chooses the upper of axis k.
  // Unsigned wrap-around gives a code that no block has.
  const auto straddles = [](std::uint32_t x) { return (x - 1) >> 2U != (x + 1) >> 2U ? 1U : 0U; };
  const std::uint32_t two = straddles(at.x) | straddles(at.y) << 1U | straddles(at.z) << 2U;
  const auto block_of = [](std::uint32_t x, bool upper) { return (upper ? x + 1 : x - 1) >> 2U; };
  std::array<const Block*, 8> blocks{};
  for (std::uint32_t side = 0; side < 8; ++side) {
    if ((side & ~two) != 0) continue;
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
      return to >> 2U == (from - 1) >> 2U ? 0U : 1U;
    };
    const Block* const block = blocks[upper(x, at.x) | upper(y, at.y) << 1U | upper(z, at.z) << 2U];
    const std::uint32_t place = place_in_cells(x, y, z);
    if (block == nullptr || (block->mask >> place & 1U) == 0) continue;
    found.add(block->first + std::popcount(block->mask & ((std::uint64_t{1} << place) - 1U)));
  }
  return found;
}

}  // namespace limen
