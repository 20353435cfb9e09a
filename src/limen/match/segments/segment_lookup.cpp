// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/segment_lookup.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kNoSegmentM = 1e-6;
constexpr double kLeastCellM = 0.5;
constexpr double kMostLookupCells = 4e6;

/// Whether a segment comes within `reach` of a box: exact enough (the box is widened, its corners are not
/// rounded off).
bool near_box(const Vector3d& middle, const Vector3d& half, const Vector3d& low, const Vector3d& high) {
  double from = -1.0;
  double to = 1.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (std::abs(half[k]) < 1e-12) {
      if (middle[k] < low[k] || middle[k] > high[k]) return false;
      continue;
    }
    double enter = (low[k] - middle[k]) / half[k];
    double leave = (high[k] - middle[k]) / half[k];
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return from <= to;
}

}  // namespace

SegmentLookup::SegmentLookup(const std::vector<Segment>& segments, double reach_m, double max_angle_rad)
    : segments_(segments.size()), reach_m_(reach_m), min_cosine_(std::cos(max_angle_rad)) {
  Vector3d high = Vector3d::Constant(-1e300);
  low_ = Vector3d::Constant(1e300);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double length = segments[i].length();
    if (!(length > kNoSegmentM)) continue;
    segments_[i] = {0.5 * (segments[i].a + segments[i].b), segments[i].direction(), 0.5 * length};
    low_ = low_.cwiseMin(segments[i].a.cwiseMin(segments[i].b));
    high = high.cwiseMax(segments[i].a.cwiseMax(segments[i].b));
  }
  if (high.x() < low_.x()) return;
  low_.array() -= reach_m_;
  high.array() += reach_m_;
  const Vector3d extent = high - low_;
  const auto count = [&](Eigen::Index k) { return std::floor(extent[k] / cell_m_) + 1.0; };
  cell_m_ = std::max(kLeastCellM, 2.0 * reach_m_);
  while (count(0) * count(1) * count(2) > kMostLookupCells) cell_m_ *= 1.25;
  for (Eigen::Index k = 0; k < 3; ++k) size_[k] = static_cast<std::int64_t>(count(k));
  begin_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]) + 1, 0);
  for (const Prepared& s : segments_) visit_cells(s, [&](std::size_t cell) { ++begin_[cell + 1]; });
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  members_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    visit_cells(segments_[i],
                [&](std::size_t cell) { members_[next[cell]++] = static_cast<std::uint32_t>(i); });
  }
}

template <typename Visit>
void SegmentLookup::visit_cells(const Prepared& segment, const Visit& visit) const {
  if (segment.half_length_m < 0.0) return;
  const Vector3d half = segment.half_length_m * segment.direction;
  std::int64_t from[3];
  std::int64_t to[3];
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double reach = std::abs(half[k]) + reach_m_;
    from[k] = static_cast<std::int64_t>(std::floor((segment.middle[k] - reach - low_[k]) / cell_m_));
    to[k] = static_cast<std::int64_t>(std::floor((segment.middle[k] + reach - low_[k]) / cell_m_));
    from[k] = std::clamp<std::int64_t>(from[k], 0, size_[k] - 1);
    to[k] = std::clamp<std::int64_t>(to[k], 0, size_[k] - 1);
  }
  for (std::int64_t z = from[2]; z <= to[2]; ++z) {
    for (std::int64_t y = from[1]; y <= to[1]; ++y) {
      for (std::int64_t x = from[0]; x <= to[0]; ++x) {
        const Vector3d corner =
            low_ + cell_m_ * Vector3d(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        const Vector3d low = (corner.array() - reach_m_).matrix();
        const Vector3d high = (corner.array() + cell_m_ + reach_m_).matrix();
        if (near_box(segment.middle, half, low, high))
          visit(static_cast<std::size_t>((z * size_[1] + y) * size_[0] + x));
      }
    }
  }
}

std::int64_t SegmentLookup::cell_of(const Vector3d& x) const {
  std::int64_t place[3];
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double at = (x[k] - low_[k]) / cell_m_;
    if (!(at >= 0.0 && at < static_cast<double>(size_[k]))) return -1;
    place[k] = static_cast<std::int64_t>(at);
  }
  return (place[2] * size_[1] + place[1]) * size_[0] + place[0];
}

SegmentHit SegmentLookup::nearest(const Vector3d& x, const Vector3d& direction) const {
  SegmentHit hit;
  const std::int64_t cell = begin_.empty() ? -1 : cell_of(x);
  if (cell < 0) return hit;
  const auto at = static_cast<std::size_t>(cell);
  double best = reach_m_ * reach_m_;
  for (std::size_t k = begin_[at]; k < begin_[at + 1]; ++k) {
    const Prepared& s = segments_[members_[k]];
    if (std::abs(s.direction.dot(direction)) < min_cosine_) continue;
    const Vector3d off = x - s.middle;
    const double along = std::clamp(s.direction.dot(off), -s.half_length_m, s.half_length_m);
    const double squared = (off - along * s.direction).squaredNorm();
    if (!(squared < best)) continue;
    best = squared;
    hit.segment = static_cast<int>(members_[k]);
  }
  hit.distance_m = std::sqrt(best);
  return hit;
}

std::vector<SegmentSample> sample_segments(const std::vector<Segment>& segments, double step_m) {
  std::vector<SegmentSample> samples;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double length = segments[i].length();
    if (!(length > kNoSegmentM)) continue;
    const Vector3d direction = segments[i].direction();
    const double count = std::max(1.0, std::ceil(length / step_m));
    for (double k = 0.5; k < count; k += 1.0) {
      samples.push_back(
          {segments[i].a + (k * length / count) * direction, direction, length / count, static_cast<int>(i)});
    }
  }
  return samples;
}

}  // namespace limen
