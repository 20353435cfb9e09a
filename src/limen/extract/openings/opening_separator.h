// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace limen {

/// Deviation that says: where the side lies was not seen.
constexpr double kUnboundedSigma_m = 1.0;

/// A sample's place across a side, growing outwards.
struct SideMark {
  double at = 0.0;
  bool wall = false;
};

/// Where a side lies, and how well it is known.
struct SideSeparator {
  double place = 0.0;  ///< outward coordinate
  double sigma_m = kUnboundedSigma_m;
  bool found = false;
};

/// Where the marks change from open to wall, going outwards: mean and standard deviation of the place given
/// all marks, each wrong with a small probability, every place in [from, to] as likely before. The search
/// ends where a pier has clearly been met.
SideSeparator separate(std::vector<SideMark> marks, double from, double to);

}  // namespace limen
