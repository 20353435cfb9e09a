// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/touching_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limen {

std::vector<std::vector<std::uint32_t>> touching_parts(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       double gap_m) {
  using Place = std::pair<int, int>;
  const PlaneFrame frame = make_frame(fit.plane, fit.centroid);
  std::map<Place, std::vector<std::uint32_t>> squares;
  for (const std::uint32_t i : points) {
    const Vector2d p = frame.to_plane(scan.points[i]) / gap_m;
    squares[{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))}].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> parts;
  while (!squares.empty()) {
    std::vector<std::uint32_t>& part = parts.emplace_back();
    std::vector<Place> open = {squares.begin()->first};
    while (!open.empty()) {
      const Place at = open.back();
      open.pop_back();
      const auto found = squares.find(at);
      if (found == squares.end()) continue;
      part.insert(part.end(), found->second.begin(), found->second.end());
      squares.erase(found);
      for (int step = 0; step < 9; ++step)
        open.emplace_back(at.first + step % 3 - 1, at.second + step / 3 - 1);
    }
    std::sort(part.begin(), part.end());
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return parts;
}

}  // namespace limen
