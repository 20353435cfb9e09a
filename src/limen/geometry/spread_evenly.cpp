// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/spread_evenly.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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
  /// Whether the cell was new.
  bool insert(std::int64_t cell) {
    std::size_t slot = mix64(static_cast<std::uint64_t>(cell)) & (slots_.size() - 1);
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

}  // namespace

std::vector<std::uint32_t> spread_evenly(const std::vector<Vector3d>& points, std::size_t most) {
  std::vector<std::uint32_t> kept(points.size());
  std::iota(kept.begin(), kept.end(), 0U);
  double cell = kFirstCellM;
  while (kept.size() > most) {
    CellSet cells(kept.size());
    std::erase_if(kept, [&](std::uint32_t i) { return !cells.insert(cell_key(cell_of(points[i], cell))); });
    // The number of points on surfaces falls with the square of the cells' width.
    const double excess =
        static_cast<double>(kept.size()) / static_cast<double>(std::max<std::size_t>(most, 1));
    cell *= std::clamp(std::sqrt(excess), kLeastGrowth, kMostGrowth);
  }
  return kept;
}

}  // namespace limen
