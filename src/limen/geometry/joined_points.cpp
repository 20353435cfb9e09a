// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/joined_points.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "limen/geometry/cell_key.h"

namespace limen {

DisjointSets joined_points(const std::vector<Vector3d>& points, double nearer_m) {
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  DisjointSets sets(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d cell = cell_of(points[i], nearer_m);
    for (int k = 0; k < 27; ++k) {
      const auto found = cells.find(cell_key(cell + way_to_cell(k)));
      if (found == cells.end()) continue;
      for (const std::size_t j : found->second)
        if ((points[i] - points[j]).squaredNorm() < nearer_m * nearer_m) sets.join(i, j);
    }
    cells[cell_key(cell)].push_back(i);
  }
  return sets;
}

}  // namespace limen
