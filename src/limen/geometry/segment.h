// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

/// A bounded straight piece from `a` to `b`, metres.
struct Segment {
  Vector3d a = Vector3d::Zero();
  Vector3d b = Vector3d::Zero();

  [[nodiscard]] double length() const { return (b - a).norm(); }
  [[nodiscard]] Vector3d direction() const { return (b - a).normalized(); }
};

inline double total_length(const std::vector<Segment>& segments) {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length();
  return sum;
}

}  // namespace limen
