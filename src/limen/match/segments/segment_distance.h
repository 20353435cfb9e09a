// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/segment.h"

// The robust distance between two sets of segments of
// - Djahel, Monasse, Vallet, "Detecting openings for indoor/outdoor registration", 2022, section 3.1,
//   equations 3 to 14 ("2022" below), and
// - Monasse, Djahel, Vallet, "Registration for urban modeling based on linear and planar features", 2023,
//   section II, equations 1 to 8 ("2023").
//
// Departures from the printed texts:
// - the bisector goes through the barycentre of the four end points (2023, figure 1): the closest point to
// two
//   lines (2022, eq. 4) is singular for parallel lines, the case that matters;
// - the second direction is turned to the first one's side before the two are added, and the sum is
//   normalised: the bisector of d and -d would vanish, and abscissae along v of another length are no metres;
// - the overlap (2022, eq. 8; 2023, eq. 3) is max(0, .): as printed it is negative for segments apart;
// - pairs that differ by more than `max_angle_rad` do not match: two segments that cross at right angles in
//   their middles would have distance 0 by 2023, eq. 4;
// - the distance of a pair is that of its four end points (2022, eq. 11 to 13), point to segment, and the end
//   points are those of the parts that overlap: with those of the whole segments, as printed, a fragment of a
//   long segment would lie half the long one's length away from it, and both texts want it at 0.
//   `whole_segments` gives the printed form;
// - what covers a segment counts once along it: where several segments of the other set cover one place, the
//   nearest does. The printed sums let (9) fall below 0, and (7) with five fragments down to -4 d^2. So every
//   term lies in [0, |L| d^2], in [0, d^2] for (7);
// - |L_1^2| of (9) is |L_1|, and the overlap is measured along L_1 itself, not along the bisector;
// - (7)'s weight is the covered share of s_1, not of the shorter of both;
// - "all segments of S_2 are too far: D >= d^2" reads D >= d;
// - (8) is symmetrised as (14) is;
// - a direction (the normal of a wall) can be taken out of all distances: the two faces of a wall lie a
//   thickness apart, and minimising the full distance would pull that thickness to zero.
//
// All of these are costs: lower is better.

namespace limen {

/// How the terms of a set distance are weighted.
enum class SegmentWeight {
  length,   ///< 2022, eq. 9: a segment counts by its length; m^3
  relative  ///< 2023, eq. 7: every segment counts the same; m^2
};

struct SegmentDistanceOptions {
  double max_distance_m = 0.15;          ///< d of both texts: segments farther apart do not match, > 0
  double max_angle_rad = radians(10.0);  ///< segments that differ by more do not match, in (0, pi/2)
  SegmentWeight weight = SegmentWeight::length;
  bool whole_segments = false;  ///< the four end points are those of the whole segments, as printed
  std::optional<Vector3d> wall_normal = {};  ///< unit: taken out of all distances and lengths
};

/// What two segments have in common. Places along a segment are metres from its `a`.
struct SegmentOverlap {
  double first_from_m = 0.0;  ///< along the first segment
  double first_to_m = 0.0;
  double second_from_m = 0.0;  ///< along the second
  double second_to_m = 0.0;
  double distance_m = 0.0;  ///< of the parts that overlap (2022, eq. 11 to 13)
};

/// The overlap of two segments along their bisector; none where they lie beside each other or differ by more
/// than the angle. The distance is not limited.
std::optional<SegmentOverlap> overlap_of(const Segment& first, const Segment& second,
                                         const SegmentDistanceOptions& options = {});

/// A segment with its direction and length at hand.
struct MeasuredSegment {
  Vector3d a;
  Vector3d b;
  Vector3d direction;
  double length = 0.0;

  [[nodiscard]] Vector3d at(double metres) const { return a + metres * direction; }
};

/// Both sides of a set distance.
struct SetDistance {
  double distance = 0.0;          ///< 2022, eq. 14: m^3 by length, m^2 by number; lower is better
  double source_distance = 0.0;   ///< the part of it that the source's segments have: (9) or (7) summed
  double nominal = 0.0;           ///< what it is where nothing matches: distance lies in [0, nominal]
  double source_covered_m = 0.0;  ///< length of the source that the target covers within max_distance_m
  double target_covered_m = 0.0;
};

/// A set of segments made ready to be compared with many others, or with one in many poses.
class SegmentSetMeasure {
 public:
  /// Segments shorter than a micrometre (the wall normal taken out) are left
  /// out.
  SegmentSetMeasure(const std::vector<Segment>& target, const SegmentDistanceOptions& options);

  /// The symmetrised distance (14) of `source`, moved by the pose, to the target.
  [[nodiscard]] SetDistance to(const std::vector<Segment>& source,
                               const Rigid3& target_from_source = {}) const;

 private:
  struct Piece {
    double from_m = 0.0;
    double to_m = 0.0;
    double gain = 0.0;
  };
  struct Cover {
    double gain = 0.0;
    double length_m = 0.0;
  };
  struct TargetPiece {
    std::size_t target = 0;
    Piece piece;
  };

  [[nodiscard]] double weigh(const MeasuredSegment& segment, double gain) const;
  [[nodiscard]] std::size_t first_near(const Vector3d& low) const;
  [[nodiscard]] static Cover cover(std::vector<Piece>& pieces);

  SegmentDistanceOptions options_;
  std::vector<MeasuredSegment> target_;  // by its low end along axis_
  Eigen::Index axis_ = 0;
  double longest_m_ = 0.0;  // along axis_
  double nominal_ = 0.0;
};

}  // namespace limen
