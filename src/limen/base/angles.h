// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace limen {

/// Angles are radians inside; degrees only at the edges.
constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}
constexpr double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

}  // namespace limen
