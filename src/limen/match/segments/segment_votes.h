// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limen/geometry/segment.h"
#include "limen/match/planes/enumerate_rotations.h"

namespace limen {

/// A set of segments as votes need it.
struct VotingSegments {
  std::vector<Vector3d> middles;
  std::vector<Vector3d> directions;  ///< unit
  std::vector<double> lengths_m;

  VotingSegments() = default;
  /// The `most` longest ones, longest first.
  VotingSegments(const std::vector<Segment>& segments, std::size_t most);
  [[nodiscard]] std::size_t size() const { return middles.size(); }
  [[nodiscard]] double total_length_m() const;
};

/// The shifts (of target_from_source) that pairs of parallel segments vote for under one rotation (2023,
/// IV-C, see enumerate_segment_poses.h), most votes first. `directions`: of the target; what differs from one
/// by less than `direction_deg` has it. Empty where no direction is common.
std::vector<Vector3d> vote_shifts(const VotingSegments& source, const VotingSegments& target,
                                  const Matrix3d& rotation, const std::vector<AxisDirection>& directions,
                                  double direction_deg);

}  // namespace limen
