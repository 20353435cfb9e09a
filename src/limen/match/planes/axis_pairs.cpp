// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/axis_pairs.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr std::size_t kMaxParts = 6;  // of one plane, largest first

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

double ShiftSupport::at(const Vector2d& in_plane) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t end = i + 1 < pairs_.size() ? pairs_[i + 1].first : boxes_.size();
    double overlap = 0.0;
    for (std::size_t k = pairs_[i].first; k < end; ++k)
      overlap += boxes_[k].source.overlap_area(boxes_[k].target, in_plane);
    sum += std::min(overlap, pairs_[i].limit_m2) * pairs_[i].weight;
  }
  return sum;
}

double AxisPairs::support(const Vector3d& translation, double tolerance) const {
  const double value = axis.direction.dot(translation);
  const Vector2d in_plane(axis.frame.u.dot(translation), axis.frame.v.dot(translation));
  const auto below = [](const PlanePair& pair, double s) { return pair.shift < s; };
  double sum = 0.0;
  for (auto it = std::lower_bound(pairs.begin(), pairs.end(), value - tolerance, below);
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
  const auto below = [](const PlanePair& pair, double s) { return pair.shift < s; };
  for (auto it = std::lower_bound(pairs.begin(), pairs.end(), value - tolerance, below);
       it != pairs.end() && it->shift <= value + tolerance; ++it) {
    const double off = (it->shift - value) / tolerance;
    support.begin_pair(it->limit_m2, 1.0 - off * off);
    for (const AxisBox& a : source_boxes[it->source]) {
      for (const AxisBox& b : target_boxes[it->target]) support.add(a, b);
    }
  }
  return support;
}

std::vector<AxisShift> best_shifts(const std::vector<PlanePair>& pairs, double tolerance, int most) {
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
