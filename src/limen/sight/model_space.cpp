// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/model_space.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kPixelM = 0.05;
constexpr double kCellM = 0.5;

/// A mask covers its polygon's box, however little of that the polygon fills. Throws Error where all of them
/// would take more than 1 GB.
void require_few_pixels(const std::vector<PlanarPolygon>& planes) {
  constexpr double kMostPixels = 8e9;
  double pixels = 0.0;
  for (const PlanarPolygon& plane : planes) {
    const Box2 box = box_of(plane.parts);
    if (box.empty()) continue;
    pixels += ((box.high - box.low) / kPixelM + Vector2d::Constant(6.0)).prod();
  }
  if (pixels <= kMostPixels) return;
  throw Error(fmt::format("the boxes round its surfaces have {:.3g} m2 in all", pixels * kPixelM * kPixelM),
              "model", "check the unit of the file, or leave out what lies around the building");
}

}  // namespace

ModelSpace::Mask ModelSpace::mask_of(const PlanarPolygon& polygon) {
  const Box2 box = box_of(polygon.parts);
  Mask mask;
  mask.plane = polygon.plane;
  mask.frame = polygon.frame;
  mask.low = box.low - Vector2d::Constant(2.0 * kPixelM);
  const Vector2d size = box.high - box.low + Vector2d::Constant(4.0 * kPixelM);
  mask.columns = 1 + static_cast<int>(size.x() / kPixelM);
  mask.rows = 1 + static_cast<int>(size.y() / kPixelM);
  const auto width = static_cast<std::size_t>(mask.columns);
  mask.bits.assign(width * static_cast<std::size_t>(mask.rows), false);
  // Each row is filled between the crossings and a pixel beyond them; rows above and below are marked too.
  for (int row = 0; row < mask.rows; ++row) {
    for (const Polygon& part : polygon.parts) {
      const std::vector<double> xs = crossings(part, mask.low.y() + (row + 0.5) * kPixelM);
      for (std::size_t k = 0; k + 1 < xs.size(); k += 2) {
        const int from = std::max(0, static_cast<int>((xs[k] - mask.low.x()) / kPixelM) - 1);
        const int to = std::min(mask.columns - 1, static_cast<int>((xs[k + 1] - mask.low.x()) / kPixelM) + 1);
        for (int above = std::max(0, row - 1); above <= std::min(mask.rows - 1, row + 1); ++above) {
          const auto at = mask.bits.begin() + static_cast<std::ptrdiff_t>(above) * mask.columns;
          std::fill(at + from, at + to + 1, true);
        }
      }
    }
  }
  return mask;
}

bool ModelSpace::Mask::covers(const Vector2d& pixel) const {
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < columns && pixel.y() < rows)) return false;
  return bits[static_cast<std::size_t>(pixel.y()) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(pixel.x())];
}

Vector2d ModelSpace::Mask::pixel_of(const Vector3d& x) const {
  return (frame.to_plane(x) - low) / kPixelM;
}

std::vector<std::int64_t> ModelSpace::cells_near(const Mask& mask, double reach_m) {
  // Places a third of a cell apart on the plane, and as far before and behind it as questions reach.
  const double step = kCellM / 3.0;
  const int layers = static_cast<int>(std::ceil(reach_m / step));
  std::vector<std::int64_t> cells;
  for (double v = 0.0; v < mask.rows * kPixelM + step; v += step) {
    for (double u = 0.0; u < mask.columns * kPixelM + step; u += step) {
      bool near = false;
      for (double dv = -step; dv <= step && !near; dv += kPixelM) {
        for (double du = -step; du <= step && !near; du += kPixelM)
          near = mask.covers(Vector2d(u + du, v + dv) / kPixelM);
      }
      if (!near) continue;
      const Vector3d x = mask.frame.to_space(mask.low + Vector2d(u, v));
      for (int layer = -layers; layer <= layers; ++layer)
        cells.push_back(cell_key(cell_of(x + layer * step * mask.plane.normal, kCellM)));
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

ModelSpace::ModelSpace(const Features& features, double reach_m) {
  const std::size_t count = features.planes.size();
  require_few_pixels(features.planes);
  masks_.resize(count);
  std::vector<std::vector<std::int64_t>> near(count);
  parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      masks_[k] = mask_of(features.planes[k]);
      near[k] = cells_near(masks_[k], reach_m);
    }
  });
  cells_ = CellLists(std::move(near));
}

Sight ModelSpace::look(const SightQuery& query) const {
  Sight sight{SightKind::unseen};
  double least = query.surface_m;
  for (const std::int32_t index : cells_.at(cell_key(cell_of(query.at, kCellM)))) {
    const Mask& mask = masks_[static_cast<std::size_t>(index)];
    const std::optional<double> distance = distance_if_same(query, {mask.plane, true});
    if (!distance || std::abs(*distance) > least || !mask.covers(mask.pixel_of(query.at))) continue;
    least = std::abs(*distance);
    sight = {SightKind::surface, index, *distance};
  }
  return sight;
}

}  // namespace limen
