// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/morton_order.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/model/scan.h"

namespace limen {
namespace {

constexpr std::uint32_t kMiddle = 1U << 20U;

std::uint32_t cell_coordinate(double x, double cell_m) {
  // Of a number that is not negative what is cut off is what std::floor, a call, would take away.
  return static_cast<std::uint32_t>(std::clamp(x / cell_m, 0.0, 2.0 * kMiddle - 1.0));
}

/// Where cell 0 begins along one axis: the lowest point, or, where stray points stretch the extent past 2^21
/// cells, half of those below the median.
double first_cell(const std::vector<Vector3d>& points, const Extent& extent, int axis, double cell_m) {
  if (extent.high[axis] - extent.low[axis] < 2.0 * kMiddle * cell_m) return extent.low[axis];
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 1001) values.push_back(points[i][axis]);
  return median(values) - kMiddle * cell_m;
}

}  // namespace

CurveOrder along_curve(const std::vector<Vector3d>& points, double cell_m) {
  CurveOrder sorted;
  if (points.empty()) return sorted;
  const Extent extent = extent_of(points);
  for (int axis = 0; axis < 3; ++axis) sorted.anchor[axis] = first_cell(points, extent, axis, cell_m);
  CurvePlaces& items = sorted.places;
  items.resize(points.size());
  const auto code_of = [&](const Vector3d& point) {
    const Vector3d x = point - sorted.anchor;
    return morton_encode(cell_coordinate(x.x(), cell_m), cell_coordinate(x.y(), cell_m),
                         cell_coordinate(x.z(), cell_m));
  };
  parallel_for(points.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) items[i] = {code_of(points[i]), static_cast<std::uint32_t>(i)};
  });
  sort_along_curve(items);
  return sorted;
}

MortonOrder morton_order(const std::vector<Vector3d>& points, double cell_m) {
  const CurveOrder along = along_curve(points, cell_m);
  MortonOrder sorted;
  sorted.cell_m = cell_m;
  sorted.anchor = along.anchor;
  sorted.codes.resize(points.size());
  bool in_order = true;
  for (std::size_t k = 0; k < points.size() && in_order; ++k) in_order = along.places[k].index == k;
  std::vector<Vector3d> moved(in_order ? 0 : points.size());
  if (!in_order) sorted.indices.resize(points.size());
  parallel_for(points.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      sorted.codes[k] = along.places[k].code;
      if (in_order) continue;
      sorted.indices[k] = along.places[k].index;
      moved[k] = points[along.places[k].index];
    }
  });
  if (in_order)
    sorted.points = std::shared_ptr<const std::vector<Vector3d>>(std::shared_ptr<const void>(), &points);
  else
    sorted.points = std::make_shared<const std::vector<Vector3d>>(std::move(moved));
  return sorted;
}

}  // namespace limen
