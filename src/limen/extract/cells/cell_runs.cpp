// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::uint32_t kBlockBits = 6;  // of a code: its place in a block of 4 x 4 x 4
constexpr std::uint64_t kInBlock = 63;
constexpr std::size_t kPlacesPerPiece = 65536;

/// Bits of the curve's code of a step along each axis, of the place in a block.
std::uint32_t place_in_cells(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return (x & 1U) | (y & 1U) << 1U | (z & 1U) << 2U | (x & 2U) << 2U | (y & 2U) << 3U | (z & 2U) << 4U;
}

/// One of the cubes around a cube.
struct Step {
  std::uint8_t block;  ///< in which of the eight blocks around it lies, as in `CellRuns::neighbours`
  std::uint8_t place;  ///< where in it
};
constexpr std::size_t kSteps = 26;
constexpr std::size_t kPlaces = 64;

/// The steps from each place in a block.
std::array<std::array<Step, kSteps>, kPlaces> all_steps() {
  std::array<std::array<Step, kSteps>, kPlaces> all{};
  for (std::uint32_t from = 0; from < kPlaces; ++from) {
    const CellIndex in_block = morton_decode(from);
    const CellIndex at = {in_block.x + 4, in_block.y + 4, in_block.z + 4};
    const auto upper = [](std::uint32_t to, std::uint32_t of) {
      return to >> 2U == (of - 1) >> 2U ? 0U : 1U;
    };
    std::size_t count = 0;
    for (std::uint32_t step = 0; step < 27; ++step) {
      if (step == 13) continue;
      const std::uint32_t x = at.x + step % 3 - 1;
      const std::uint32_t y = at.y + step / 3 % 3 - 1;
      const std::uint32_t z = at.z + step / 9 - 1;
      all[from][count++] = {
          static_cast<std::uint8_t>(upper(x, at.x) | upper(y, at.y) << 1U | upper(z, at.z) << 2U),
          static_cast<std::uint8_t>(place_in_cells(x, y, z))};
    }
  }
  return all;
}

/// How many bits are set. Not every processor that this runs on has an instruction for it, and a call takes
/// longer.
std::int32_t count_bits(std::uint64_t bits) {
  bits -= (bits >> 1U) & 0x5555555555555555ULL;
  bits = (bits & 0x3333333333333333ULL) + ((bits >> 2U) & 0x3333333333333333ULL);
  bits = (bits + (bits >> 4U)) & 0x0f0f0f0f0f0f0f0fULL;
  return static_cast<std::int32_t>((bits * 0x0101010101010101ULL) >> 56U);
}

}  // namespace

int level_of(double cell_m, double finest_m) {
  return std::max(0, static_cast<int>(std::lround(std::log2(cell_m / finest_m))));
}

CellRuns::CellRuns(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level) {
  const int shift = 3 * level;
  make_runs(active.size(), [&](std::size_t k) { return sorted.codes[active[k]] >> shift; });
}

CellRuns::CellRuns(const MortonOrder& sorted, int level) {
  const int shift = 3 * level;
  make_runs(sorted.codes.size(), [&](std::size_t k) { return sorted.codes[k] >> shift; });
}

template <typename CodeAt>
void CellRuns::make_runs(std::size_t places, const CodeAt& code_at) {
  std::vector<std::vector<std::uint32_t>> pieces((places + kPlacesPerPiece - 1) / kPlacesPerPiece);
  parallel_for(places, kPlacesPerPiece, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& piece = pieces[begin / kPlacesPerPiece];
    for (std::size_t k = begin; k < end; ++k) {
      if (k == 0 || code_at(k) != code_at(k - 1)) piece.push_back(static_cast<std::uint32_t>(k));
    }
  });
  std::size_t runs = 0;
  for (const std::vector<std::uint32_t>& piece : pieces) runs += piece.size();
  begins_.reserve(runs + 1);
  for (const std::vector<std::uint32_t>& piece : pieces)
    begins_.insert(begins_.end(), piece.begin(), piece.end());
  codes_.reserve(runs);
  for (const std::uint32_t begin : begins_) codes_.push_back(code_at(begin));
  finish(static_cast<std::uint32_t>(places));
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
  static const Block none;
  std::array<const Block*, 8> blocks{&none, &none, &none, &none, &none, &none, &none, &none};
  for (std::uint32_t side = 0; side < 8; ++side) {
    if ((side & ~two) != 0) continue;
    const Block* const block =
        find(morton_encode(block_of(at.x, (side & 1U) != 0), block_of(at.y, (side & 2U) != 0),
                           block_of(at.z, (side & 4U) != 0)));
    if (block != nullptr) blocks[side] = block;
  }
  static const std::array<std::array<Step, kSteps>, kPlaces> steps = all_steps();
  CellNeighbours found;
  for (const Step& step : steps[codes_[i] & kInBlock]) {
    const Block& block = *blocks[step.block];
    if ((block.mask >> step.place & 1U) == 0) continue;
    found.add(block.first + count_bits(block.mask & ((std::uint64_t{1} << step.place) - 1U)));
  }
  return found;
}

}  // namespace limen
