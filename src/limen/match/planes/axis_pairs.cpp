// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/axis_pairs.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr std::size_t kMaxParts = 6;  // of one plane, largest first

/// Extent of a box along a unit vector.
struct BoxReach {
  double low = 0.0;
  double high = 0.0;
};

BoxReach reach_along(const AxisBox& box, const Vector2d& way) {
  const Vector2d middle = 0.5 * (box.low + box.high);
  const double half = 0.5 * (box.high - box.low).dot(way.cwiseAbs());
  return {middle.dot(way) - half, middle.dot(way) + half};
}

}  // namespace

std::vector<AxisBox> boxes_of(const PlanarPolygon& plane, const Matrix3d& rotation, const MatchAxis& axis) {
  std::vector<AxisBox> boxes;
  for (const Polygon& part : plane.parts) {
    if (boxes.size() == kMaxParts) break;
    AxisBox box;
    for (const Vector2d& p : part.outer) {
      const Vector2d q = axis.frame.to_plane(rotation * plane.frame.to_space(p));
      box.low = box.low.cwiseMin(q);
      box.high = box.high.cwiseMax(q);
    }
    const Vector2d size = box.high - box.low;
    box.fill = std::min(1.0, area(part) / std::max(1e-9, size.x() * size.y()));
    boxes.push_back(box);
  }
  return boxes;
}

double ShiftSupport::at(const Vector2d& in_plane, double enough) const {
  double sum = 0.0;
  double rest = most_m2_;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (sum + rest <= enough) return std::max(0.0, sum + rest);
    rest -= pairs_[i].limit_m2 * pairs_[i].weight;
    if (!pairs_[i].meets(in_plane)) continue;
    const std::size_t end = i + 1 < pairs_.size() ? pairs_[i + 1].first : boxes_.size();
    double overlap = 0.0;
    for (std::size_t k = pairs_[i].first; k < end; ++k)
      overlap += boxes_[k].source.overlap_area(boxes_[k].target, in_plane);
    sum += std::min(overlap, pairs_[i].limit_m2) * pairs_[i].weight;
  }
  return sum;
}

std::vector<double> ShiftSupport::most_where(const Vector2d& way, const std::vector<double>& along_m) const {
  const Vector2d across(-way.y(), way.x());
  const std::size_t count = along_m.size();
  std::vector<double> sums(count, 0.0);
  std::vector<double> overlaps(count);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t end = i + 1 < pairs_.size() ? pairs_[i + 1].first : boxes_.size();
    std::fill(overlaps.begin(), overlaps.end(), 0.0);
    for (std::size_t k = pairs_[i].first; k < end; ++k) {
      const AxisBox& a = boxes_[k].source;
      const AxisBox& b = boxes_[k].target;
      const BoxReach from = reach_along(a, way);
      const BoxReach to = reach_along(b, way);
      const BoxReach wide_a = reach_along(a, across);
      const BoxReach wide_b = reach_along(b, across);
      const double width = std::min(wide_a.high - wide_a.low, wide_b.high - wide_b.low) * a.fill * b.fill;
      for (std::size_t n = 0; n < count; ++n) {
        const double common =
            std::min(from.high + along_m[n], to.high) - std::max(from.low + along_m[n], to.low);
        overlaps[n] += std::max(common, 0.0) * width;
      }
    }
    for (std::size_t n = 0; n < count; ++n)
      sums[n] += std::min(overlaps[n], pairs_[i].limit_m2) * pairs_[i].weight;
  }
  for (double& sum : sums) sum = 1.000001 * sum + 1e-9;  // so that rounding does no harm
  return sums;
}

void AxisPairs::index(double tolerance) {
  begins.clear();
  most.clear();
  if (pairs.empty()) return;
  constexpr double kMostSteps = 100000.0;
  low = pairs.front().shift;
  const double length = pairs.back().shift - low;
  step = std::max(tolerance, length / kMostSteps);
  begins.assign(static_cast<std::size_t>(length / step) + 2, pairs.size());
  for (std::size_t i = pairs.size(); i-- > 0;)
    begins[static_cast<std::size_t>((pairs[i].shift - low) / step)] = i;
  for (std::size_t k = begins.size() - 1; k-- > 0;) begins[k] = std::min(begins[k], begins[k + 1]);

  // A little wider than the tolerance, so that rounding does no harm.
  const double reach = 1.001 * tolerance;
  most_step = std::max(0.25 * tolerance, length / kMostSteps);
  first_most = low - reach;
  most.assign(static_cast<std::size_t>((length + 2.0 * reach) / most_step) + 1, 0.0);
  std::size_t first = 0;
  std::size_t last = 0;
  double within = 0.0;
  for (std::size_t k = 0; k < most.size(); ++k) {
    const double begin = first_most + static_cast<double>(k) * most_step;
    while (last < pairs.size() && pairs[last].shift <= begin + most_step + reach)
      within += pairs[last++].limit_m2;
    while (first < last && pairs[first].shift < begin - reach) within -= pairs[first++].limit_m2;
    if (first == last) within = 0.0;
    most[k] = 1.000001 * within + 1e-9;
  }
}

std::size_t AxisPairs::first_from(double value) const {
  if (pairs.empty() || value <= low) return 0;
  const double place = (value - low) / step;
  if (place >= static_cast<double>(begins.size())) return pairs.size();
  std::size_t at = begins[static_cast<std::size_t>(place)];
  while (at < pairs.size() && pairs[at].shift < value) ++at;
  return at;
}

double AxisPairs::support(const Vector3d& translation, double tolerance) const {
  const double value = axis.direction.dot(translation);
  const Vector2d in_plane(axis.frame.u.dot(translation), axis.frame.v.dot(translation));
  double sum = 0.0;
  for (auto it = pairs.begin() + static_cast<std::ptrdiff_t>(first_from(value - tolerance));
       it != pairs.end() && it->shift <= value + tolerance; ++it) {
    double overlap = 0.0;
    for (const AxisBox& a : source_boxes[it->source]) {
      for (const AxisBox& b : target_boxes[it->target]) overlap += a.overlap_area(b, in_plane);
    }
    const double off = (it->shift - value) / tolerance;
    sum += std::min(overlap, it->limit_m2) * (1.0 - off * off);
  }
  return sum;
}

ShiftSupport AxisPairs::support_at(double value, double tolerance) const {
  ShiftSupport support;
  for (auto it = pairs.begin() + static_cast<std::ptrdiff_t>(first_from(value - tolerance));
       it != pairs.end() && it->shift <= value + tolerance; ++it) {
    const double off = (it->shift - value) / tolerance;
    support.begin_pair(it->limit_m2, 1.0 - off * off);
    for (const AxisBox& a : source_boxes[it->source]) {
      for (const AxisBox& b : target_boxes[it->target]) support.add(a, b);
    }
  }
  return support;
}

std::vector<AxisShift> best_shifts(const std::vector<ShiftPair>& pairs, double tolerance, int most) {
  std::vector<AxisShift> all;
  std::size_t low = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (pairs[low].shift < pairs[i].shift - tolerance) ++low;
    AxisShift shift;
    double mean = 0.0;
    for (std::size_t k = low; k < pairs.size() && pairs[k].shift <= pairs[i].shift + tolerance; ++k) {
      shift.limit_m2 += pairs[k].limit_m2;
      mean += pairs[k].limit_m2 * pairs[k].shift;
    }
    shift.value = mean / shift.limit_m2;
    all.push_back(shift);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const AxisShift& a, const AxisShift& b) { return a.limit_m2 > b.limit_m2; });
  std::vector<AxisShift> kept;
  for (const AxisShift& shift : all) {
    if (static_cast<int>(kept.size()) == most) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const AxisShift& other) {
      return std::abs(other.value - shift.value) < 0.5 * tolerance;
    });
    if (!known) kept.push_back(shift);
  }
  return kept;
}

}  // namespace limen
