// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/side_order.h"

#include <algorithm>
#include <tuple>

namespace limen {
namespace {

double seen_m2(const Features& features) {
  double sum = 0.0;
  for (const SurfaceSample& sample : features.samples) sum += static_cast<double>(sample.area_m2);
  return sum;
}

/// What a side is ordered by before its single samples.
auto rough_order(const PreparedScan& side) {
  const Features& features = side.extracted.features;
  return std::tuple(side.model, side.mobile, seen_m2(features), features.samples.size());
}

bool comes_before(const SurfaceSample& a, const SurfaceSample& b) {
  return std::tuple(a.mean.x(), a.mean.y(), a.mean.z(), a.area_m2) <
         std::tuple(b.mean.x(), b.mean.y(), b.mean.z(), b.area_m2);
}

}  // namespace

bool is_work_order(const PreparedScan& source, const PreparedScan& target) {
  const auto first = rough_order(source);
  const auto second = rough_order(target);
  if (first != second) return first < second;
  const std::vector<SurfaceSample>& own = source.extracted.features.samples;
  const std::vector<SurfaceSample>& others = target.extracted.features.samples;
  return !std::lexicographical_compare(others.begin(), others.end(), own.begin(), own.end(), comes_before);
}

WorkedPair worked_pair(const PreparedPair& pair) {
  if (is_work_order(pair.source, pair.target)) return {pair.source, pair.target, false};
  return {pair.target, pair.source, true};
}

}  // namespace limen
