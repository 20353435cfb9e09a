// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/segment.h"
#include "limen/match/segments/segment_lookup.h"
#include "limen/register/refine/refine_pose.h"

namespace limen {

/// Segments nearer than this are matched in the last round: several times the noise of a segment's ends.
inline constexpr double kLastSegmentGateM = 0.05;
/// Segments whose directions differ by more are never matched.
inline constexpr double kMatchedSegmentsDeg = 10.0;

/// How two sets of segments lie on each other under one pose.
struct SegmentFit {
  RefinedPose pose;           ///< `geometry_m2` has metres of segments as weights here, not m^2
  int matched_segments = 0;   ///< of the moved set
  double matched_m = 0.0;     ///< their length that lies on the other set within the last gate
  double evidence_m = 0.0;    ///< the same, weighted, a segment counting for no more than a short one
  std::vector<double> met_m;  ///< of every piece of the moved set: its part of evidence_m
  bool in_one_plane = false;  ///< all matched segments lie in one plane
};

/// Least squares over matched segments: pieces of the moved set against the lines they lie by (point to line;
/// the directions are held by the pieces along a segment). 2023, IV-D, is its linear form for two pairs.
///
/// The deviations come from how the matched segments scatter, every segment being two ends' worth of
/// evidence, however long.
class SegmentRefiner {
 public:
  /// The sets must outlive the refiner.
  SegmentRefiner(const std::vector<Segment>& moved, const std::vector<Segment>& fixed);

  /// The pose near `start` and what it matches.
  [[nodiscard]] SegmentFit refine(const Rigid3& fixed_from_moved) const;
  /// The largest `evidence_m` there could be.
  [[nodiscard]] double total_evidence_m() const { return total_evidence_m_; }

 private:
  struct Match {
    std::size_t piece = 0;
    int fixed = -1;
    Vector3d at = Vector3d::Zero();          // the piece, moved
    Vector3d residual = Vector3d::Zero();    // from the piece to the line, across it
    Vector3d direction = Vector3d::UnitX();  // of the line
    double weight = 0.0;                     // ends' worth
  };
  [[nodiscard]] std::vector<Match> match(const Rigid3& pose, double gate_m) const;
  std::size_t weigh(std::size_t first, std::vector<Match>& matches) const;
  [[nodiscard]] static Vector3d middle_of(const std::vector<Match>& matches);
  static void adjust(const std::vector<Match>& matches, double gate_m, Rigid3& pose);
  static void summarise(const std::vector<Match>& matches, double gate_m, SegmentFit& fit);
  void count(const std::vector<Match>& matches, SegmentFit& fit) const;

  const std::vector<Segment>& fixed_;
  SegmentLookup lookup_;
  std::vector<SegmentSample> pieces_;
  std::vector<double> evidence_m_;  // of each piece
  double total_evidence_m_ = 0.0;
};

}  // namespace limen
