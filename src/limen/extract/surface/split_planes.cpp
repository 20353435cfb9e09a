// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/split_planes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "limen/base/error.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

using Cell = std::pair<int, int>;

/// Points by pieces, largest piece first: cells of the plane that touch, also at a corner, hang together.
std::vector<std::vector<std::uint32_t>> pieces_of(const Scan& scan, const PlaneFit& fit,
                                                  const std::vector<std::uint32_t>& points, double gap_m) {
  const PlaneFrame frame = make_frame(fit.plane, fit.centroid);
  std::map<Cell, std::vector<std::uint32_t>> cells;
  for (const std::uint32_t i : points) {
    const Vector2d p = frame.to_plane(scan.points[i]) / gap_m;
    cells[{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))}].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> pieces;
  while (!cells.empty()) {
    std::vector<std::uint32_t>& piece = pieces.emplace_back();
    std::vector<Cell> open = {cells.begin()->first};
    while (!open.empty()) {
      const Cell at = open.back();
      open.pop_back();
      const auto found = cells.find(at);
      if (found == cells.end()) continue;
      piece.insert(piece.end(), found->second.begin(), found->second.end());
      cells.erase(found);
      for (int step = 0; step < 9; ++step)
        open.emplace_back(at.first + step % 3 - 1, at.second + step / 3 - 1);
    }
    std::sort(piece.begin(), piece.end());
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return pieces;
}

PlaneFit fit_of(const Scan& scan, const std::vector<std::uint32_t>& points) {
  const Vector3d anchor = scan.points[points.front()];
  PointMoments moments;
  for (const std::uint32_t i : points) moments.add(scan.points[i] - anchor);
  PlaneFit fit = fit_plane(moments);
  fit.plane = shifted(fit.plane, -anchor);
  fit.centroid += anchor;
  return fit;
}

}  // namespace

void SplitOptions::check() const {
  if (!(gap_m > 0)) throw_bad_option("gap_m", gap_m, "more than 0");
  if (min_inliers < 3) throw_bad_option("split min_inliers", min_inliers, "3 or more");
}

PlaneLabels split_planes(const Scan& scan, const PlaneLabels& planes, const SplitOptions& options) {
  options.check();
  PlaneLabels split;
  split.inlier_threshold_m = planes.inlier_threshold_m;
  split.labels.assign(planes.labels.size(), -1);
  const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const std::vector<std::uint32_t>& piece :
         pieces_of(scan, planes.fits[k], points[k], options.gap_m)) {
      if (piece.size() < static_cast<std::size_t>(options.min_inliers)) break;
      for (const std::uint32_t i : piece) split.labels[i] = static_cast<std::int32_t>(split.fits.size());
      split.fits.push_back(fit_of(scan, piece));
    }
  }
  return split;
}

}  // namespace limen
