// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/segment.h"

namespace limen {

/// What a place on a segment of one set meets in another set.
struct SegmentHit {
  int segment = -1;         ///< index into the looked-up set; -1: nothing within reach
  double distance_m = 0.0;  ///< to the nearest point of it
};

/// Segments made ready to be asked, many times, which of them passes near a point in about a given direction.
class SegmentLookup {
 public:
  /// `reach_m` > 0: farther segments are not found. `max_angle_rad` in (0, pi/2): nor those that differ more
  /// in direction. Segments shorter than a micrometre are never found.
  SegmentLookup(const std::vector<Segment>& segments, double reach_m, double max_angle_rad);

  /// The nearest segment; the first of equally near ones. `direction`: unit, either sign.
  [[nodiscard]] SegmentHit nearest(const Vector3d& x, const Vector3d& direction) const;
  [[nodiscard]] double reach_m() const { return reach_m_; }

 private:
  struct Prepared {
    Vector3d middle = Vector3d::Zero();
    Vector3d direction = Vector3d::UnitX();
    double half_length_m = -1.0;  ///< negative: too short
  };
  /// Cell counts, or -1 outside.
  [[nodiscard]] std::int64_t cell_of(const Vector3d& x) const;
  template <typename Visit>
  void visit_cells(const Prepared& segment, const Visit& visit) const;

  std::vector<Prepared> segments_;
  double reach_m_ = 0.0;
  double min_cosine_ = 0.0;
  double cell_m_ = 0.5;
  Vector3d low_ = Vector3d::Zero();
  std::int64_t size_[3] = {0, 0, 0};
  std::vector<std::uint32_t> begin_;  ///< of each cell in members_, and one more
  std::vector<std::uint32_t> members_;
};

/// A short piece of a segment, represented by its middle.
struct SegmentSample {
  Vector3d at = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitX();
  double length_m = 0.0;  ///< of the piece
  int segment = -1;       ///< index into the sampled set
};

/// Every segment cut into equal pieces no longer than `step_m`; those shorter than a micrometre left out.
std::vector<SegmentSample> sample_segments(const std::vector<Segment>& segments, double step_m);

}  // namespace limen
