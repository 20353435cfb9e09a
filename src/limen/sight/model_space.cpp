// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/model_space.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/cell_key.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kPixelM = 0.05;
constexpr double kCellM = 0.5;

/// Abscissae at which the rings cross the height y, ascending.
std::vector<double> crossings(const Polygon& polygon, double y) {
  std::vector<double> xs;
  const auto add = [&](const Ring& ring) {
    Vector2d a = ring.back();
    for (const Vector2d& b : ring) {
      if ((a.y() <= y) != (b.y() <= y)) xs.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
      a = b;
    }
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  std::sort(xs.begin(), xs.end());
  return xs;
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

bool ModelSpace::Mask::covers(const Vector3d& x) const {
  const Vector2d p = (frame.to_plane(x) - low) / kPixelM;
  if (!(p.x() >= 0 && p.y() >= 0 && p.x() < columns && p.y() < rows)) return false;
  return bits[static_cast<std::size_t>(p.y()) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(p.x())];
}

void ModelSpace::enter(std::int32_t index, double reach_m) {
  const Mask& mask = masks_[static_cast<std::size_t>(index)];
  // Places a third of a cell apart on the plane, and as far before and behind it as questions reach.
  const double step = kCellM / 3.0;
  const int layers = static_cast<int>(std::ceil(reach_m / step));
  for (double v = 0.0; v < mask.rows * kPixelM + step; v += step) {
    for (double u = 0.0; u < mask.columns * kPixelM + step; u += step) {
      const Vector3d x = mask.frame.to_space(mask.low + Vector2d(u, v));
      bool near = false;
      for (double dv = -step; dv <= step && !near; dv += kPixelM) {
        for (double du = -step; du <= step && !near; du += kPixelM)
          near = mask.covers(mask.frame.to_space(mask.low + Vector2d(u + du, v + dv)));
      }
      if (!near) continue;
      for (int layer = -layers; layer <= layers; ++layer) {
        std::vector<std::int32_t>& cell =
            cells_[cell_key(cell_of(x + layer * step * mask.plane.normal, kCellM))];
        if (cell.empty() || cell.back() != index) cell.push_back(index);
      }
    }
  }
}

ModelSpace::ModelSpace(const Features& features, double reach_m) {
  masks_.reserve(features.planes.size());
  for (const PlanarPolygon& polygon : features.planes) {
    masks_.push_back(mask_of(polygon));
    enter(static_cast<std::int32_t>(masks_.size() - 1), reach_m);
  }
}

Sight ModelSpace::look(const SightQuery& query) const {
  Sight sight{SightKind::unseen};
  const auto found = cells_.find(cell_key(cell_of(query.at, kCellM)));
  if (found == cells_.end()) return sight;
  double least = query.surface_m;
  for (const std::int32_t index : found->second) {
    const Mask& mask = masks_[static_cast<std::size_t>(index)];
    const std::optional<double> distance = distance_if_same(query, {mask.plane, true});
    if (!distance || std::abs(*distance) > least || !mask.covers(query.at)) continue;
    least = std::abs(*distance);
    sight = {SightKind::surface, index, *distance};
  }
  return sight;
}

}  // namespace limen
