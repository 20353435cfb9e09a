// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/scanner.h"

namespace limen {

/// Somebody who stood in the way while one scan was taken.
struct Person {
  Vector2d at = Vector2d::Zero();
  double floor_m = 0.0;
  double height_m = 1.7;
  double heading_rad = 0.0;
};

/// Up to `count` people in a room, clear of furniture, at least 0.8 m from the scanner.
std::vector<Person> people_in(const Building& building, std::size_t room, const Vector3d& scanner, int count,
                              RandomStream& random);

/// Echoes behind people are replaced by echoes on them: their surface becomes -1.
void hide_behind(Sweep& sweep, const Vector3d& scanner, const std::vector<Person>& people, double noise_m,
                 RandomStream& random);

}  // namespace limen
