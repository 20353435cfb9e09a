// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/segment_distance.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace limen {
namespace {

constexpr double kNoLengthM = 1e-6;

Vector3d without(const std::optional<Vector3d>& normal, const Vector3d& x) {
  return normal ? Vector3d(x - normal->dot(x) * *normal) : x;
}

double point_distance(const Vector3d& p, const Vector3d& a, const Vector3d& direction, double length) {
  const double along = std::clamp(direction.dot(p - a), 0.0, length);
  return (p - a - along * direction).norm();
}

/// 2022, equations 11 to 13, for the parts [from, to] of two segments.
double four_end_distance(const MeasuredSegment& first, double first_from, double first_to,
                         const MeasuredSegment& second, double second_from, double second_to) {
  const Vector3d a1 = first.at(first_from);
  const Vector3d b1 = first.at(first_to);
  const Vector3d a2 = second.at(second_from);
  const Vector3d b2 = second.at(second_to);
  const double length1 = first_to - first_from;
  const double length2 = second_to - second_from;
  return (point_distance(a1, a2, second.direction, length2) +
          point_distance(b1, a2, second.direction, length2) +
          point_distance(a2, a1, first.direction, length1) +
          point_distance(b2, a1, first.direction, length1)) /
         4.0;
}

/// The part of a segment whose abscissae on the bisector lie in [low, high], metres from its `a`.
std::pair<double, double> part_between(const MeasuredSegment& segment, double start, double slope, double low,
                                       double high) {
  double from = (low - start) / slope;
  double to = (high - start) / slope;
  if (from > to) std::swap(from, to);
  return {std::clamp(from, 0.0, segment.length), std::clamp(to, 0.0, segment.length)};
}

std::optional<SegmentOverlap> overlap(const MeasuredSegment& first, const MeasuredSegment& second,
                                      double min_cosine, bool whole_segments) {
  const double cosine = first.direction.dot(second.direction);
  if (std::abs(cosine) < min_cosine) return std::nullopt;
  const Vector3d bisector = (first.direction + (cosine < 0.0 ? -1.0 : 1.0) * second.direction).normalized();
  const Vector3d barycentre = (first.a + first.b + second.a + second.b) / 4.0;
  const double start1 = bisector.dot(first.a - barycentre);  // 2022 (6), 2023 (1)
  const double start2 = bisector.dot(second.a - barycentre);
  const double slope1 = bisector.dot(first.direction);
  const double slope2 = bisector.dot(second.direction);
  const double end1 = start1 + slope1 * first.length;
  const double end2 = start2 + slope2 * second.length;
  const double low = std::max(std::min(start1, end1), std::min(start2, end2));  // 2022 (8), 2023 (3)
  const double high = std::min(std::max(start1, end1), std::max(start2, end2));
  if (!(high > low)) return std::nullopt;
  SegmentOverlap result;
  std::tie(result.first_from_m, result.first_to_m) = part_between(first, start1, slope1, low, high);
  std::tie(result.second_from_m, result.second_to_m) = part_between(second, start2, slope2, low, high);
  result.distance_m = whole_segments ? four_end_distance(first, 0.0, first.length, second, 0.0, second.length)
                                     : four_end_distance(first, result.first_from_m, result.first_to_m,
                                                         second, result.second_from_m, result.second_to_m);
  return result;
}

/// Whether the box of a segment leaves the box [low, high].
bool apart(const Vector3d& a, const Vector3d& b, const Vector3d& low, const Vector3d& high) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (std::max(a[i], b[i]) < low[i] || std::min(a[i], b[i]) > high[i]) return true;
  }
  return false;
}

/// `normal`: taken out.
MeasuredSegment measured(const std::optional<Vector3d>& normal, const Segment& segment) {
  const Vector3d a = without(normal, segment.a);
  const Vector3d b = without(normal, segment.b);
  const double length = (b - a).norm();
  return {a, b, length > kNoLengthM ? Vector3d((b - a) / length) : Vector3d::UnitX(), length};
}

/// Length of [from, to] that no interval in `taken` covers; `taken` is sorted and free of overlaps.
double free_length(const std::vector<std::pair<double, double>>& taken, double from, double to) {
  double length = to - from;
  for (const auto& [low, high] : taken) length -= std::max(0.0, std::min(to, high) - std::max(from, low));
  return std::max(0.0, length);
}

/// `taken` with [from, to] joined to it.
void take(std::vector<std::pair<double, double>>& taken, double from, double to) {
  std::vector<std::pair<double, double>> joined;
  for (const auto& part : taken) {
    if (part.second < from || part.first > to) {
      joined.push_back(part);
    } else {
      from = std::min(from, part.first);
      to = std::max(to, part.second);
    }
  }
  joined.emplace_back(from, to);
  taken = std::move(joined);
}

}  // namespace

std::optional<SegmentOverlap> overlap_of(const Segment& first, const Segment& second,
                                         const SegmentDistanceOptions& options) {
  const MeasuredSegment a = measured(options.wall_normal, first);
  const MeasuredSegment b = measured(options.wall_normal, second);
  if (a.length <= kNoLengthM || b.length <= kNoLengthM) return std::nullopt;
  return overlap(a, b, std::cos(options.max_angle_rad), options.whole_segments);
}

SegmentSetMeasure::SegmentSetMeasure(const std::vector<Segment>& target,
                                     const SegmentDistanceOptions& options)
    : options_(options) {
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  for (const Segment& segment : target) {
    const MeasuredSegment ready = measured(options_.wall_normal, segment);
    if (ready.length <= kNoLengthM) continue;
    low = low.cwiseMin(0.5 * (ready.a + ready.b));
    high = high.cwiseMax(0.5 * (ready.a + ready.b));
    nominal_ += weigh(ready, 0.0);
    target_.push_back(ready);
  }
  if (target_.empty()) return;
  (high - low).maxCoeff(&axis_);
  const auto low_end = [this](const MeasuredSegment& s) { return std::min(s.a[axis_], s.b[axis_]); };
  std::stable_sort(target_.begin(), target_.end(), [&](const MeasuredSegment& x, const MeasuredSegment& y) {
    return low_end(x) < low_end(y);
  });
  for (const MeasuredSegment& s : target_)
    longest_m_ = std::max(longest_m_, std::abs(s.b[axis_] - s.a[axis_]));
}

/// The term of one segment: (9) or (7), given what its cover takes off.
double SegmentSetMeasure::weigh(const MeasuredSegment& segment, double gain) const {
  const double squared = options_.max_distance_m * options_.max_distance_m;
  const double term = std::clamp(segment.length * squared - gain, 0.0, segment.length * squared);
  return options_.weight == SegmentWeight::length ? term : term / segment.length;
}

/// Where segments of the target begin that may come within the distance of `low` along the sorting axis.
std::size_t SegmentSetMeasure::first_near(const Vector3d& low) const {
  const auto begin = std::lower_bound(
      target_.begin(), target_.end(), low[axis_] - longest_m_,
      [this](const MeasuredSegment& s, double value) { return std::min(s.a[axis_], s.b[axis_]) < value; });
  return static_cast<std::size_t>(begin - target_.begin());
}

/// Every place along a segment counts once, for the piece with the largest gain there.
SegmentSetMeasure::Cover SegmentSetMeasure::cover(std::vector<Piece>& pieces) {
  if (pieces.empty()) return {};
  if (pieces.size() == 1) {
    const double length = pieces[0].to_m - pieces[0].from_m;
    return {length * pieces[0].gain, length};
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
    return std::tie(y.gain, x.from_m, x.to_m) < std::tie(x.gain, y.from_m, y.to_m);
  });
  Cover result;
  std::vector<std::pair<double, double>> taken;
  for (const Piece& piece : pieces) {
    const double length = free_length(taken, piece.from_m, piece.to_m);
    result.gain += length * piece.gain;
    result.length_m += length;
    take(taken, piece.from_m, piece.to_m);
  }
  return result;
}

SetDistance SegmentSetMeasure::to(const std::vector<Segment>& source,
                                  const Rigid3& target_from_source) const {
  const double squared = options_.max_distance_m * options_.max_distance_m;
  const double min_cosine = std::cos(options_.max_angle_rad);
  SetDistance result;
  result.nominal = nominal_;
  std::vector<TargetPiece> on_target;
  std::vector<Piece> pieces;
  for (const Segment& segment : source) {
    const MeasuredSegment s =
        measured(options_.wall_normal, {target_from_source * segment.a, target_from_source * segment.b});
    if (s.length <= kNoLengthM) continue;
    const Vector3d low = (s.a.cwiseMin(s.b).array() - options_.max_distance_m).matrix();
    const Vector3d high = (s.a.cwiseMax(s.b).array() + options_.max_distance_m).matrix();
    pieces.clear();
    for (std::size_t k = first_near(low); k < target_.size(); ++k) {
      const MeasuredSegment& t = target_[k];
      if (std::min(t.a[axis_], t.b[axis_]) > high[axis_]) break;
      if (apart(t.a, t.b, low, high)) continue;
      const auto common = overlap(s, t, min_cosine, options_.whole_segments);
      if (!common) continue;
      const double gain = squared - common->distance_m * common->distance_m;
      if (gain <= 0.0) continue;
      pieces.push_back({common->first_from_m, common->first_to_m, gain});
      on_target.push_back({k, {common->second_from_m, common->second_to_m, gain}});
    }
    const Cover covered = cover(pieces);
    result.nominal += weigh(s, 0.0);
    result.source_distance += weigh(s, covered.gain);
    result.source_covered_m += covered.length_m;
  }
  result.distance = result.source_distance + nominal_;
  std::stable_sort(on_target.begin(), on_target.end(),
                   [](const TargetPiece& x, const TargetPiece& y) { return x.target < y.target; });
  for (auto it = on_target.begin(); it != on_target.end();) {
    pieces.clear();
    const std::size_t k = it->target;
    for (; it != on_target.end() && it->target == k; ++it) pieces.push_back(it->piece);
    const Cover covered = cover(pieces);
    result.distance += weigh(target_[k], covered.gain) - weigh(target_[k], 0.0);
    result.target_covered_m += covered.length_m;
  }
  result.distance = std::clamp(result.distance, 0.0, result.nominal);
  return result;
}

}  // namespace limen
