// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/spread_evenly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "limen/base/random.h"
#include "limen/geometry/cell_key.h"

namespace limen {
namespace {

constexpr double kFirstCellM = 0.01;
constexpr double kLeastGrowth = 1.15;  // of the cells from try to try
constexpr double kMostGrowth = 2.0;

/// A set of cells, open addressing: asked a million times per scan.
class CellSet {
 public:
  explicit CellSet(std::size_t members) {
    std::size_t size = 1024;
    while (size < 2 * members) size *= 2;
    slots_.assign(size, -1);
  }
  [[nodiscard]] std::size_t slot_of(std::int64_t cell) const {
    const std::size_t slot = mix64(static_cast<std::uint64_t>(cell)) & (slots_.size() - 1);
    __builtin_prefetch(&slots_[slot]);
    return slot;
  }
  /// Whether the cell was new.
  bool insert(std::int64_t cell, std::size_t slot) {
    while (slots_[slot] != -1) {
      if (slots_[slot] == cell) return false;
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = cell;
    return true;
  }

 private:
  std::vector<std::int64_t> slots_;
};

/// Keeps the first of each cell. Memory answers for many at a time.
void keep_first_of_each(const std::vector<Vector3d>& points, double cell_m,
                        std::vector<std::uint32_t>& kept) {
  constexpr std::size_t kAtATime = 64;
  CellSet cells(kept.size());
  std::array<std::pair<std::int64_t, std::size_t>, kAtATime> asked;
  std::size_t first = 0;
  for (std::size_t begin = 0; begin < kept.size(); begin += kAtATime) {
    const std::size_t count = std::min(kAtATime, kept.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const std::int64_t cell = cell_key(cell_of(points[kept[begin + k]], cell_m));
      asked[k] = {cell, cells.slot_of(cell)};
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (cells.insert(asked[k].first, asked[k].second)) kept[first++] = kept[begin + k];
    }
  }
  kept.resize(first);
}

}  // namespace

std::vector<std::uint32_t> spread_evenly(const std::vector<Vector3d>& points, std::size_t most) {
  std::vector<std::uint32_t> kept(points.size());
  std::iota(kept.begin(), kept.end(), 0U);
  double cell = kFirstCellM;
  while (kept.size() > most) {
    keep_first_of_each(points, cell, kept);
    // The number of points on surfaces falls with the square of the cells' width.
    const double excess =
        static_cast<double>(kept.size()) / static_cast<double>(std::max<std::size_t>(most, 1));
    cell *= std::clamp(std::sqrt(excess), kLeastGrowth, kMostGrowth);
  }
  return kept;
}

}  // namespace limen
