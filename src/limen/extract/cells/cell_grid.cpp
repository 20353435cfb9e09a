// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_grid.h"

#include <cmath>
#include <span>

#include "limen/base/parallel.h"

namespace limen {

CellGrid::CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level)
    : runs_(sorted, active, level), cells_(runs_.size()), edge_m_(sorted.cell_m * std::exp2(level)) {
  std::vector<std::uint32_t> shaped;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    cell.begin = runs_.begin(i);
    cell.end = runs_.end(i);
    if (cell.count() < kLeastOfShape) continue;
    cell.shape = static_cast<std::int32_t>(shaped.size());
    shaped.push_back(static_cast<std::uint32_t>(i));
  }
  shapes_.resize(shaped.size());
  const std::span<const std::uint32_t> points(active);
  parallel_for(shaped.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Cell& cell = cells_[shaped[k]];
      shapes_[k] = shape_of(sorted, points.subspan(cell.begin, cell.count()), level);
    }
  });
}

}  // namespace limen
