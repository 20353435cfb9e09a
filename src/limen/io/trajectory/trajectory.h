// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/model/scan.h"

namespace limen {

/// Where a moving scanner was, and when.
class Trajectory {
 public:
  /// Times in seconds, positions in metres, as many. They are sorted by time; of equal times at one place one
  /// stays. Between two that are further apart than `max_gap_s` nothing is known. Throws Error where there
  /// are fewer than two, a number is not finite, or one time has places more than 1 cm apart. `name` and
  /// `option_side` (TrajectoryOptions::option_side) are for messages.
  Trajectory(const std::vector<double>& times_s, const std::vector<Vector3d>& positions, std::string name,
             double max_gap_s = 1.0, std::string option_side = {});

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& option_side() const { return option_side_; }
  [[nodiscard]] std::size_t size() const { return times_s_.size(); }
  [[nodiscard]] double time_s(std::size_t i) const { return times_s_[i]; }
  [[nodiscard]] const Vector3d& place(std::size_t i) const { return positions_[i]; }
  [[nodiscard]] double first_s() const { return times_s_.front(); }
  [[nodiscard]] double last_s() const { return times_s_.back(); }
  /// On the line between the places before and after; empty outside of the times and within gaps.
  [[nodiscard]] std::optional<Vector3d> position(double time_s) const;

 private:
  std::vector<double> times_s_;
  std::vector<Vector3d> positions_;
  std::string name_;
  double max_gap_s_;
  std::string option_side_;
};

/// A scan with its scanner positions.
struct FollowedScan {
  Scan scan;
  std::size_t left_out = 0;  ///< points at times that the trajectory does not cover
};

/// Which of several trajectories a scan was measured along: the one that covers most of its times, at least
/// half, and passes near its points. Nothing where the scan has no times, or none does.
const Trajectory* covering_trajectory(const Scan& scan,
                                      const std::vector<std::shared_ptr<const Trajectory>>& trajectories);

/// The scan with the scanner position of each point by its time. Throws Error where the scan has no times,
/// where no time of it is covered (with both ranges, and what would bring them together), or where the
/// trajectory passes nowhere near the points.
FollowedScan with_trajectory(const Scan& scan, const Trajectory& trajectory);

}  // namespace limen
