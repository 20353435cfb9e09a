// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/features.h"

namespace limen {

/// MatchAxis-aligned rectangle in the coordinates of an axis.
struct AxisBox {
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = Vector2d::Constant(-1e300);
  double fill = 1.0;  // share of the rectangle that the polygon covers

  [[nodiscard]] double overlap_area(const AxisBox& other, const Vector2d& shift) const {
    const double w =
        std::min(high.x() + shift.x(), other.high.x()) - std::max(low.x() + shift.x(), other.low.x());
    if (!(w > 0)) return 0.0;
    const double h =
        std::min(high.y() + shift.y(), other.high.y()) - std::max(low.y() + shift.y(), other.low.y());
    return h > 0 ? w * h * fill * other.fill : 0.0;
  }
};

/// One direction of the target with in-plane coordinates, and the planes that have it.
struct MatchAxis {
  PlaneFrame frame;  // origin 0; u, v span the planes
  Vector3d direction = Vector3d::UnitZ();
};

/// The boxes of a plane's largest parts along an axis, the plane turned by `rotation`.
std::vector<AxisBox> boxes_of(const PlanarPolygon& plane, const Matrix3d& rotation, const MatchAxis& axis);

/// A plane of the source that may be a plane of the target, and the shift along the axis that makes it so.
struct ShiftPair {
  double shift = 0.0;
  std::size_t source = 0;
  std::size_t target = 0;
  double limit_m2 = 0.0;  // no more than the smaller of the two can overlap
};

/// Candidate shift along one axis: pairs within the tolerance of it.
struct AxisShift {
  double value = 0.0;
  double limit_m2 = 0.0;
};

/// Surface that comes together along one axis at one of its shifts, by where the source lies along the axis's
/// planes: what a loop over all shifts asks again and again, in one piece of memory.
class ShiftSupport {
 public:
  void begin_pair(double limit_m2, double weight) {
    pairs_.push_back({.limit_m2 = limit_m2, .weight = weight, .first = boxes_.size()});
    most_m2_ += limit_m2 * weight;
  }
  /// A box of either plane of the pair begun last.
  void add(const AxisBox& source, const AxisBox& target) {
    constexpr double kSlackM = 1e-9;  // so that rounding does no harm
    boxes_.push_back({source, target});
    PairPlace& pair = pairs_.back();
    pair.meets_from = pair.meets_from.cwiseMin(target.low - source.high - Vector2d::Constant(kSlackM));
    pair.meets_to = pair.meets_to.cwiseMax(target.high - source.low + Vector2d::Constant(kSlackM));
  }

  /// m^2, at a shift `in_plane` of the source across the axis. Where it is plain that it is no more than
  /// `enough`, something between it and `enough`.
  [[nodiscard]] double at(const Vector2d& in_plane, double enough) const;
  /// No shift gives more, m^2.
  [[nodiscard]] double most() const { return most_m2_; }
  /// For each of `along_m`: no shift that goes so far along the unit vector `way` of the axis's plane gives
  /// more, m^2.
  [[nodiscard]] std::vector<double> most_where(const Vector2d& way, const std::vector<double>& along_m) const;

 private:
  struct PairPlace {
    double limit_m2;
    double weight;
    std::size_t first;  // of its boxes
    // No boxes of the pair meet at a shift outside these.
    Vector2d meets_from = Vector2d::Constant(1e300);
    Vector2d meets_to = Vector2d::Constant(-1e300);

    [[nodiscard]] bool meets(const Vector2d& shift) const {
      return shift.x() > meets_from.x() && shift.x() < meets_to.x() && shift.y() > meets_from.y() &&
             shift.y() < meets_to.y();
    }
  };
  struct BoxPair {
    AxisBox source;
    AxisBox target;
  };
  std::vector<PairPlace> pairs_;
  std::vector<BoxPair> boxes_;
  double most_m2_ = 0.0;
};

/// All pairs along one axis under one rotation, by shift.
struct AxisPairs {
  MatchAxis axis;
  std::vector<ShiftPair> pairs;
  std::vector<std::vector<AxisBox>> source_boxes;  ///< per source plane; empty where it is not of this axis
  std::vector<std::vector<AxisBox>> target_boxes;
  std::vector<AxisShift> shifts;
  double weight_m2 = 0.0;
  // Where the pairs begin, in steps along the axis.
  std::vector<std::size_t> begins;
  double low = 0.0;
  double step = 1.0;
  // The most that any value within a finer step can bring together; the first step begins at `first_most`.
  std::vector<double> most;
  double first_most = 0.0;
  double most_step = 1.0;

  /// Makes these of the sorted pairs; `tolerance`: that of support() and most_near().
  void index(double tolerance);
  /// The first pair at `value` or above.
  [[nodiscard]] std::size_t first_from(double value) const;
  /// No shift of that value along the axis gives more support, m^2.
  [[nodiscard]] double most_near(double value) const {
    const double place = (value - first_most) / most_step;
    return place >= 0.0 && place < static_cast<double>(most.size()) ? most[static_cast<std::size_t>(place)]
                                                                    : 0.0;
  }
  /// Surface that comes together at a shift of the source, m^2.
  [[nodiscard]] double support(const Vector3d& translation, double tolerance) const;
  /// The same at a shift along the axis, for any shift across it.
  [[nodiscard]] ShiftSupport support_at(double value, double tolerance) const;
};

/// Shifts that bring most surface together, heaviest first, no two nearer than half the tolerance; `pairs` by
/// shift.
std::vector<AxisShift> best_shifts(const std::vector<ShiftPair>& pairs, double tolerance, int most);

}  // namespace limen
