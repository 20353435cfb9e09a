// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/morton_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/model/scan.h"

namespace limen {
namespace {

constexpr std::uint32_t kMiddle = 1U << 20U;
constexpr std::size_t kPieces = 16;
constexpr std::uint32_t kDigitBits = 11;
constexpr std::uint32_t kDigits = 1U << kDigitBits;

std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | (v << 32U)) & 0x1f00000000ffffULL;
  v = (v | (v << 16U)) & 0x1f0000ff0000ffULL;
  v = (v | (v << 8U)) & 0x100f00f00f00f00fULL;
  v = (v | (v << 4U)) & 0x10c30c30c30c30c3ULL;
  return (v | (v << 2U)) & 0x1249249249249249ULL;
}

std::uint32_t gather(std::uint64_t v) {
  v &= 0x1249249249249249ULL;
  v = (v | (v >> 2U)) & 0x10c30c30c30c30c3ULL;
  v = (v | (v >> 4U)) & 0x100f00f00f00f00fULL;
  v = (v | (v >> 8U)) & 0x1f0000ff0000ffULL;
  v = (v | (v >> 16U)) & 0x1f00000000ffffULL;
  v = (v | (v >> 32U)) & 0x1fffffULL;
  return static_cast<std::uint32_t>(v);
}

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
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2] - kMiddle * cell_m;
}

/// One stable pass of a radix sort on `shift`'s digit; pieces keep their order, whoever works on them.
void radix_pass(const CurvePlaces& from, CurvePlaces& to, std::uint32_t shift) {
  const std::size_t n = from.size();
  const std::size_t grain = (n + kPieces - 1) / kPieces;
  std::vector<std::array<std::uint32_t, kDigits>> starts(kPieces);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint32_t, kDigits>& count = starts[begin / grain];
    count.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++count[(from[i].code >> shift) & (kDigits - 1)];
  });
  const std::size_t used = (n + grain - 1) / grain;
  std::uint32_t total = 0;
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    for (std::size_t piece = 0; piece < used; ++piece) {
      const std::uint32_t count = starts[piece][digit];
      starts[piece][digit] = total;
      total += count;
    }
  }
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint32_t, kDigits>& next = starts[begin / grain];
    for (std::size_t i = begin; i < end; ++i) to[next[(from[i].code >> shift) & (kDigits - 1)]++] = from[i];
  });
}

}  // namespace

std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | (spread(y) << 1U) | (spread(z) << 2U);
}

CellIndex morton_decode(std::uint64_t code) {
  return {gather(code), gather(code >> 1U), gather(code >> 2U)};
}

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
  const std::uint64_t first = code_of(points.front());
  const std::uint64_t differ = parallel_reduce(
      points.size(), 65536, std::uint64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t part = 0;
        for (std::size_t i = begin; i < end; ++i) {
          items[i] = {code_of(points[i]), static_cast<std::uint32_t>(i)};
          part |= items[i].code ^ first;
        }
        return part;
      },
      [](std::uint64_t a, std::uint64_t b) { return a | b; });
  // Points that were laid along the curve once stay so, also with larger cubes.
  if (std::is_sorted(items.begin(), items.end(),
                     [](const CurvePlace& a, const CurvePlace& b) { return a.code < b.code; }))
    return sorted;
  CurvePlaces other(items.size());
  // Digits above the highest bit in which any two codes differ need no pass.
  const auto bits = static_cast<std::uint32_t>(std::bit_width(differ));
  for (std::uint32_t shift = 0; shift < bits; shift += kDigitBits) {
    radix_pass(items, other, shift);
    items.swap(other);
  }
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
