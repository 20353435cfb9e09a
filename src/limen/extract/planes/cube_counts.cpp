// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/cube_counts.h"

#include <algorithm>
#include <numeric>

#include "limen/base/parallel.h"

namespace limen {

CubeCounts::CubeCounts(const CellRuns& runs, const std::vector<std::int32_t>& labels, double least)
    : begins_(runs.size() + 1, 0) {
  constexpr std::size_t kCubes = 1024;
  std::vector<std::vector<PlaneCount>> pieces((runs.size() + kCubes - 1) / kCubes);
  parallel_for(runs.size(), kCubes, [&](std::size_t begin, std::size_t end) {
    std::vector<PlaneCount>& piece = pieces[begin / kCubes];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = piece.size();
      for (std::uint32_t k = runs.begin(i); k < runs.end(i); ++k) {
        if (labels[k] >= 0) add_count(piece, before, {labels[k], 1.0});
      }
      piece.erase(std::remove_if(piece.begin() + static_cast<std::ptrdiff_t>(before), piece.end(),
                                 [&](const PlaneCount& it) { return it.count < least; }),
                  piece.end());
      begins_[i + 1] = piece.size() - before;
    }
  });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  counts_.reserve(begins_.back());
  for (const auto& piece : pieces) counts_.insert(counts_.end(), piece.begin(), piece.end());
}

}  // namespace limen
