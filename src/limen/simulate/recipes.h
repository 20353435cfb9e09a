// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limen/simulate/scene.h"

namespace limen {

/// What a scene consists of before it is scanned. Building 0 is the one that matters.
struct Recipe {
  World world;
  std::vector<std::size_t> station_rooms;  ///< rooms of building 0, one per station
  std::vector<std::size_t> spare_rooms;    ///< as good as the first of them, should that one be too full
  bool through_door = false;  ///< the two stations stand in rooms joined by an open door, in sight
  std::size_t points_indoor = 260000;
  std::size_t points_outdoor = 0;
  bool wants_view = false;          ///< stations are placed where they see much through their windows
  std::optional<VehiclePath> path;  ///< of the mobile scan
  std::vector<double> head_turns_rad = {0.0};  ///< one head across the path, or two askew
  bool national_grid = false;                  ///< world coordinates far from zero
};

/// Builds the scene named in the options. Throws Error for an unknown name.
Recipe make_recipe(const SceneOptions& options);

}  // namespace limen
