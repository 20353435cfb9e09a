// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "limen/model/scan.h"
#include "limen/register/frame/scan_frame.h"

namespace limen {

/// How many points are kept of a scan that has more than its features need.
struct KeepOptions {
  /// On a square metre of a surface that faces the scanner; 0: any number. Of static stations: a scanner of
  /// even angular steps puts ever more points on what is near.
  double most_per_m2 = 5000.0;
  std::size_t most_points = 4'000'000;  ///< together, about; 0: any number
  /// The same of a scanner that moved, for what is nearer than half of what it saw: the road under a vehicle
  /// holds most of its points and needs the fewest. 0: any number.
  double most_per_m2_of_way = 1000.0;
};

/// Every point, untouched.
constexpr KeepOptions kKeepAll = {0.0, 0, 0.0};

/// Indices of the points to keep, ascending; nothing: all, also where hardly any would go.
///
/// A point at range r is kept with a probability that grows with r² (with r where the scanner moved along a
/// way: its lines lie side by side), the same for all points at that range until it is 1: what is far off
/// stays as it is, and what is near becomes as dense as what is far. The range changes by nothing within the
/// noise of a surface, so no side of it is favoured. Where the scanner's place is unknown all points are kept
/// with one probability. Which are kept depends on where they lie in the frame, to a millimetre, and not on
/// their order.
std::optional<std::vector<std::uint32_t>> kept_points(const Scan& scan, const ScanFrame& frame,
                                                      const KeepOptions& options);

}  // namespace limen
